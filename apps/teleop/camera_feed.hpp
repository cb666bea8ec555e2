/// @file
/// A simulated depth camera that looks at a running cell, and the parts that are made of its
/// images.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <repel/base/ring.hpp>
#include <repel/cell/cell.hpp>
#include <repel/loop/record.hpp>
#include <repel/percepts/depth_memory.hpp>
#include <repel/percepts/own_body.hpp>
#include <repel/percepts/perceived_parts.hpp>
#include <repel/percepts/simulated_camera.hpp>
#include <repel/robots/kinematics.hpp>
#include <repel/robots/robot.hpp>
#include <repel/scene/scene.hpp>
#include <repel/schedule/deadline.hpp>

namespace repel::teleop {

/// [m] Largest reach of a part that is made of an image.
constexpr double room_of_seen = 1.1;

/// What has become of the images of a run.
struct CameraResult {
  std::int64_t images = 0;    ///< of which parts were made
  std::int64_t lost = 0;      ///< that came faster than they could be used
  int most_cells = 0;         ///< of an image
  std::int64_t left_out = 0;  ///< cells for which no reserved part was free, over all images
  std::int64_t made = 0;      ///< parts made, over all images
  double silent = 0.0;        ///< [s] time in which the camera counted as silent
  DurationHistogram compute;  ///< from an image to its parts, without drawing the image
  std::string nearest_pair;   ///< "part - hidden"; empty if nothing is hidden
  /// [m] Least signed distance of an arm or its tool from what the camera sees and the world model
  /// does not know: from the hidden parts themselves, not from what was made of them.
  double least_clearance = std::numeric_limits<double>::infinity();
};

/// Where everything that a camera can see of a scene is.
class Sights {
 public:
  /// @param robots of the arms of the cell, in their order
  Sights(const scene::Scene& scene, const std::vector<Robot>& robots, const Cell& cell);

  /// The poses [m] in the world after a tick, in the order of `meshes`; not finite: not there. The
  /// first are in the world model, the others hidden.
  void place(std::span<const TickRecord* const> records, std::vector<Pose>& X_W) noexcept;

  [[nodiscard]] std::vector<TriangleMesh> meshes() const;
  /// The shapes of those in the world model.
  [[nodiscard]] std::vector<Shape> known() const;
  [[nodiscard]] std::size_t size() const noexcept { return sights_.size(); }

  /// Keeps the least distance of arms and tools from hidden parts at these poses.
  void measure(const std::vector<Pose>& X_W, CameraResult& result) const;

 private:
  struct Sight {
    std::string name;
    Shape shape;
    Pose X = Pose::Identity();  ///< [m] in its link, in its tool frame, or in the world
    int arm = -1;               ///< -1: none
    int link = 0;               ///< of the arm; -1: its base
    bool is_tool = false;
    bool is_hidden = false;
    PartId loose{};  ///< that can come and go
    std::optional<ReciprocatingMotion> motion{};
  };

  [[nodiscard]] Pose pose_of(const Sight& sight, double time) const noexcept;

  const Cell& cell_;
  std::vector<Kinematics> kinematics_;
  std::vector<std::size_t> joints_;
  std::vector<Sight> sights_;
};

/// Takes images of a running cell and makes parts of them: between the ticks, where a run is not by
/// the clock, which repeats itself; otherwise on a thread of its own.
class CameraFeed {
 public:
  /// @param scene with a camera @param cell must outlive this object
  /// @param in_step between the ticks @param on_add see PerceivedOptions
  CameraFeed(const scene::Scene& scene, const std::vector<Robot>& robots, Cell& cell, bool in_step,
             std::function<void(PartId, const Shape&)> on_add);
  ~CameraFeed() { stop(); }
  CameraFeed(const CameraFeed&) = delete;
  CameraFeed& operator=(const CameraFeed&) = delete;

  /// After every tick, outside of its time. By the clock it never waits.
  /// @param is_blind the camera gives no image now
  void follow(std::span<const TickRecord* const> records, bool is_blind);
  /// [s] Age of the last image of which parts were made, if the camera counts as silent, otherwise
  /// 0. Of the thread of the tick.
  [[nodiscard]] double silent_for() const noexcept;
  /// Ends the thread. Once: then what has become of the images.
  void stop();
  [[nodiscard]] const CameraResult& result() const noexcept { return result_; }

 private:
  struct Scenery {
    double time = 0.0;  ///< [s]
    std::vector<Pose> X_W;
  };

  /// Makes parts of the images whose time has come. Returns false if there are none.
  bool serve();
  void look(const Scenery& scenery);

  const scene::CameraChoice choice_;
  percepts::DepthCamera camera_;
  Sights sights_;
  percepts::SimulatedCamera simulated_;
  percepts::OwnBody own_;
  percepts::DepthMemory memory_;
  percepts::DepthCells division_;
  percepts::PerceivedParts parts_;
  std::vector<float> image_;
  std::vector<Pose> X_C_;  ///< [m] in the frame of the camera
  std::span<const percepts::Cell> cells_;
  bool has_looked_ = false;  ///< at the oldest image in the ring
  std::vector<Pose> X_W_;    ///< [m] at the last tick
  Ring<Scenery> ring_;
  double next_ = 0.0;  ///< [s] when the next image is due
  std::atomic<double> now_{0.0};
  std::atomic<double> seen_at_{0.0};  ///< [s] when the last image was taken that was used
  double period_ = 0.0;               ///< [s] of the tick
  bool in_step_;
  DurationHistogram looked_, made_;
  std::chrono::nanoseconds looking_{0};  ///< at the oldest image in the ring
  CameraResult result_;
  std::jthread thread_;
};

}  // namespace repel::teleop

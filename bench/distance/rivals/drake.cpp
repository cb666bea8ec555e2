// SPDX-License-Identifier: BSD-3-Clause
#include <drake/geometry/scene_graph.h>

#include "rival.hpp"

namespace repel::bench {

namespace {

namespace dg = drake::geometry;

class Drake {
 public:
  using Result = dg::SignedDistancePair<double>;

  Drake(const Task& task, double) : task_(task) {
    const dg::SourceId source = scene_.RegisterSource();
    std::vector<dg::FrameId> frames;
    for (const Solid& s : task.solids) {
      const std::string name = std::to_string(frames.size());
      frames.push_back(scene_.RegisterFrame(source, dg::GeometryFrame(name)));
      solids_.push_back(scene_.RegisterGeometry(
          source, frames.back(),
          std::make_unique<dg::GeometryInstance>(drake::math::RigidTransformd(), shape(s), name)));
      scene_.AssignRole(source, solids_.back(), dg::ProximityProperties());
    }
    // Every tick has a context of its own. Its first query places the solids, and that is not
    // timed: the answers are checked before.
    for (const std::vector<Pose>& X_W : task.X_W) {
      dg::FramePoseVector<double> poses;
      for (std::size_t i = 0; i < frames.size(); ++i) {
        poses.set_value(frames[i], drake::math::RigidTransformd(X_W[i]));
      }
      contexts_.push_back(scene_.CreateDefaultContext());
      scene_.get_source_pose_port(source).FixValue(contexts_.back().get(), poses);
      queries_.push_back(
          &scene_.get_query_output_port().Eval<dg::QueryObject<double>>(*contexts_.back()));
    }
  }

  Result cold(const Ask& ask) {
    const auto& [a, b] = task_.pairs[ask.pair];
    return queries_[ask.tick]->ComputeSignedDistancePairClosestPoints(solids_[a], solids_[b]);
  }
  Result warm(const Ask& ask) { return cold(ask); }
  static Answer read(const Result& r) {
    return {.distance = r.distance, .extraction_W = r.nhat_BA_W};
  }

 private:
  static std::unique_ptr<dg::Shape> shape(const Solid& s) {
    if (s.box) return std::make_unique<dg::Box>(2.0 * s.half_extents);
    Eigen::Matrix3Xd vertices(3, s.vertices.size());
    for (std::size_t i = 0; i < s.vertices.size(); ++i) {
      vertices.col(static_cast<Eigen::Index>(i)) = s.vertices[i];
    }
    return std::make_unique<dg::Convex>(vertices, "hull");
  }

  const Task& task_;
  dg::SceneGraph<double> scene_;
  std::vector<dg::GeometryId> solids_;
  std::vector<std::unique_ptr<drake::systems::Context<double>>> contexts_;
  std::vector<const dg::QueryObject<double>*> queries_;
};

const Enlisted enlisted({
    .name = "drake",
    .version = REPEL_RIVAL_VERSION,
    .settings = "QueryObject::ComputeSignedDistancePairClosestPoints, the cheapest public call for "
                "one pair; its tolerance is fixed; keeps nothing from tick to tick",
    .tolerance = 1e-6,
    .sweeps = false,
    .warms = false,
    .load = Adapter<Drake>::load,
});

}  // namespace

}  // namespace repel::bench

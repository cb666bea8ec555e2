// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The depth cameras of a scene.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <repel/base/types.hpp>
#include <repel/force/law.hpp>

namespace repel::scene {

/// [Hz] Of the images of a camera, simulated or recorded: what waits for its latency is kept.
inline constexpr double most_camera_rate_hz = 1000.0;

/// A map in which the images of a camera are entered.
struct MapChoice {
  double cube = 0.05;        ///< [m] edge of its cubes
  double keeps = 2.0;        ///< [s] what is seen no more, but not seen through either
  Vec3 low = Vec3::Zero();   ///< [m] corners of the region of the map: all that the camera can see
  Vec3 high = Vec3::Zero();  ///< [m]
};

/// An image of a recording.
struct RecordedImage {
  double time = 0.0;  ///< [s] its time stamp
  std::string file;   ///< path
};

/// Depth images that were recorded, instead of those of a simulated camera.
struct RecordingChoice {
  std::string folder;                 ///< path of the images
  std::vector<RecordedImage> images;  ///< in the order of their times, 1 or more
  double fx = 0.0;                    ///< [px] focal length across
  double fy = 0.0;                    ///< [px] focal length down
  double cx = 0.0;                    ///< [px] column of the centre of the image
  double cy = 0.0;                    ///< [px] its row
  double unit = 1e-3;                 ///< [m] of what an image has in a pixel
  bool repeats = false;               ///< it begins again at its end
};

/// A depth camera that looks at the scene, simulated, and the parts that are made of its images.
struct CameraChoice {
  std::string name;              ///< empty: that of the key `camera`, the only one
  Pose X_WC = Pose::Identity();  ///< [m] x to the right of the image, y down, z along the axis
  int width = 320;               ///< [px]
  int height = 240;              ///< [px]
  double view = 1.05;            ///< [rad] across the image
  double nearest = 0.2;          ///< [m] nearer depths are not measured
  double farthest = 4.0;         ///< [m] nor are farther ones
  double rate_hz = 30.0;         ///< [Hz]
  double latency = 0.033;        ///< [s] from an image to the parts made of it
  double noise = 0.0;            ///< [m] standard deviation at 1 m
  double lost = 0.0;             ///< share of pixels without a depth
  std::uint64_t seed = 1;        ///< of both
  bool is_unseen_solid = false;  ///< what is behind something that is seen
  double margin = 0.03;          ///< [m] around what is in the model: is taken out of images
  int parts = 400;               ///< reserved
  double silent_after = 0.2;     ///< [s] without an image the operator's commands no longer count
  ForceLaw law;                  ///< of the parts
  std::optional<MapChoice> map;  ///< none: each image becomes parts by itself
  std::optional<RecordingChoice> recording;  ///< none: the camera is simulated
};

}  // namespace repel::scene

// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reads where cameras are, and what is known of recorded depth images.
#pragma once

#include <string>

#include <repel/scene/camera.hpp>

#include "yaml.hpp"

namespace repel::scene::detail {

/// A camera at `position` that looks at a point, `look_at`, its image upright; or with
/// `orientation`, a quaternion x y z w of its axes.
[[nodiscard]] Pose pose_of_camera(const Map& map);

/// Reads `camera.yaml` of a folder, and lists the images beside it in `depth`, in the order of
/// their time stamps, which are their names. Sets the pose, the size, the focal lengths, and the
/// mean rate of `camera`.
/// @throws SetupError naming file, line and value of what is wrong
[[nodiscard]] RecordingChoice recording_of(const std::string& folder, CameraChoice& camera);

}  // namespace repel::scene::detail

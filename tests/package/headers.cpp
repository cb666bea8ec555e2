// SPDX-License-Identifier: BSD-3-Clause
// The headers of the parts selected by PARTS. Including them is enough for the linker to check that
// program and parts were built with compatible options.
#ifdef PART_robots
#include <repel/robots/dynamics.hpp>
#include <repel/robots/kinematics.hpp>
#include <repel/robots/mjcf.hpp>
#include <repel/robots/parts.hpp>
#include <repel/robots/read_mesh.hpp>
#include <repel/robots/urdf.hpp>
#include <repel/robots/visuals.hpp>
#endif
#ifdef PART_common
#include <repel/common/complaint.hpp>
#include <repel/common/deadline.hpp>
#include <repel/common/input_limits.hpp>
#include <repel/common/text_file.hpp>
#endif
#ifdef PART_simulated
#include <repel/simulated/brake_torque.hpp>
#include <repel/simulated/changed_arm.hpp>
#include <repel/simulated/contact.hpp>
#include <repel/simulated/delayed_arm.hpp>
#include <repel/simulated/sensed_arm.hpp>
#include <repel/simulated/simulated_arm.hpp>
#endif
#ifdef PART_link
#include <repel/link/datagrams.hpp>
#include <repel/link/link_thread.hpp>
#include <repel/link/udp.hpp>
#include <repel/link/wire.hpp>
#endif
#ifdef PART_dds
#include <repel/dds/dds.hpp>
#endif
#ifdef PART_sealed
#include <repel/sealed/key.hpp>
#include <repel/sealed/sealed.hpp>
#endif
#ifdef PART_percepts
#include <repel/percepts/depth_image_file.hpp>
#include <repel/percepts/depth_memory.hpp>
#include <repel/percepts/own_body.hpp>
#include <repel/percepts/perceived_parts.hpp>
#include <repel/percepts/simulated_camera.hpp>
#endif
#ifdef PART_octrees
#include <repel/octrees/depth_map.hpp>
#include <repel/octrees/mapped_parts.hpp>
#endif
#ifdef PART_cover
#include <repel/cover/cover.hpp>
#include <repel/cover/occupancy.hpp>
#endif
#ifdef PART_bullet
#include <repel/bullet/arm.hpp>
#endif
#ifdef PART_ode
#include <repel/ode/arm.hpp>
#endif
#ifdef PART_mujoco
#include <repel/mujoco/arm.hpp>
#endif
#ifdef PART_scene
#include <repel/scene/build_network.hpp>
#include <repel/scene/part_list.hpp>
#include <repel/scene/scene.hpp>
#endif
#ifdef PART_visual
#include <repel/visual/live_view.hpp>
#include <repel/visual/messages.hpp>
#endif

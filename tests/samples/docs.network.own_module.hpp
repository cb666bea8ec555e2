// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the samples of docs/network/own_module.md leave out.
#pragma once

#include <cstdio>

#include <repel/control.hpp>
#include <repel/repel.hpp>
#include <repel/scene/scene.hpp>

using namespace repel::network;
namespace scene = repel::scene;
extern const Network network;

struct Honey : repel::network::Visual {
  explicit Honey(double damping);
};

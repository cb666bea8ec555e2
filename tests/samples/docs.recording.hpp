// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the samples of docs/recording.md leave out.
#pragma once

#include <cstdio>
#include <string>

extern const std::string scene_text;
extern const std::uint32_t sequence;
extern const std::uint64_t time_ns;
template <class Topic, class Data>
void use(const Topic& topic, const Data& data);

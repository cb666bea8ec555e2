// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The live view of a run and its server.
#pragma once

#include <memory>
#include <string>

#include <repel/loop/tap.hpp>
#include <repel/runs/operator/controls.hpp>
#include <repel/runs/options/session_options.hpp>
#include <repel/runs/records/heading.hpp>
#include <repel/runs/setup/prepared_run.hpp>

namespace repel::runs {

/// It is served for as long as this object exists.
class View {
 public:
  virtual ~View() = default;
  View(const View&) = delete;
  View& operator=(const View&) = delete;

 protected:
  View() = default;
};

/// Serves the live view, and prints its URL on stderr.
/// @param prepared its world and its options are shown @param heading the names that are shown
/// @param tap of that world, read from now on; it and `controls` must outlive the view
/// @param device name of the master that drives whenever no page does; empty: none
/// @throws SetupError if the address or the page is not available, or the view is not built in
[[nodiscard]] std::unique_ptr<View> open_view(const PreparedRun& prepared, const Heading& heading,
                                              bool is_replay, Tap& tap, Controls& controls,
                                              const SessionOptions& session,
                                              const std::string& device);

}  // namespace repel::runs

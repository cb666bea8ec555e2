// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The pages of a run, served.
#pragma once

#include <memory>
#include <string>

#include <repel/loop/tap.hpp>
#include <repel/visual/controls.hpp>
#include <repel/visual/messages.hpp>
#include <repel/visual/page_folder.hpp>
#include <repel/visual/server.hpp>

namespace repel::visual {

/// How a view is served, and what pages may do.
struct ViewOptions {
  bool pages_drive = false;            ///< false: pages look on only
  std::string master = "The program";  ///< who drives while no page does; empty: a script
  std::string page{};                  ///< folder of the files of the page; empty: page_folder()
  ServerOptions server{};  ///< address, port, and a secret where other machines reach them
};

/// Serves what a tap passes on to pages, and passes their commands on to controls, in a thread of
/// its own, for as long as it exists. Allocates there, and never waits for the loop.
class RunView {
 public:
  /// @param world its names and shapes are told to each page
  /// @param tap of that world; it and `controls` must outlive this object
  /// @throws SetupError if the files of the page are missing, the address is not available, or
  /// other machines reach it and it has no secret of 16 characters or more
  RunView(const SceneInfo& info, const World& world, Tap& tap, Controls& controls,
          const ViewOptions& options);
  RunView(const RunView&) = delete;
  RunView& operator=(const RunView&) = delete;
  ~RunView();

  /// The URL of the page for a browser on this machine: "http://127.0.0.1:8448/".
  [[nodiscard]] const std::string& url() const noexcept;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace repel::visual

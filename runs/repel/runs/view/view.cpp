// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/view/view.hpp>

#include <repel/base/setup_error.hpp>
#include <repel/runs/options/listening.hpp>
#include <repel/runs/view/arm_inputs_info.hpp>
#include <repel/runs/view/browser.hpp>
#include <repel/runs/view/visuals_info.hpp>

#ifdef REPEL_RUNS_VISUAL

#include <any>
#include <cmath>
#include <cstdlib>
#include <vector>

#include <repel/network/modules/spaceball.hpp>
#include <repel/visual/live_view.hpp>

namespace repel::runs {
namespace {

using namespace std::string_literals;

/// Adds what is told of parts besides their shapes.
void add_shown(const std::vector<scene::Shown>& shown, visual::SceneInfo& info) {
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const PartId part{static_cast<std::int32_t>(i)};
    const auto& [gaps, of, paint] = shown[i];
    if (!of.empty() || paint.color || paint.opacity) {
      info.looks.push_back({part, of, paint.color, paint.opacity});
    }
    if (gaps.count == 0) continue;
    visual::GapsInfo& told = info.gaps.emplace_back();
    told.part = part;
    told.count = gaps.count;
    for (const scene::Gap& gap : gaps.deepest) told.deepest.push_back({gap.p_M, gap.depth});
  }
}

visual::SceneInfo scene_info_of(const PreparedRun& prepared, const Heading& heading,
                                bool is_replay) {
  const scene::Scene& scene = prepared.scene;
  const Cell& cell = prepared.cell;
  const RunOptions& options = prepared.options;
  visual::SceneInfo info = visual::scene_info_of(cell, scene.name);
  add_shown(prepared.shown, info);
  info.replay = is_replay;
  info.duration = info.replay ? options.seconds : 0.0;
  const auto spare =
      cell.loose().subspan(scene.loose.size(), static_cast<std::size_t>(scene.spare.count));
  info.spare.assign(spare.begin(), spare.end());
  for (std::size_t i = 0; i < heading.arms.size(); ++i) {
    visual::ArmInfo& added = info.arms[i];
    added.modules = heading.arms[i].modules;
    added.phases = heading.arms[i].phases;
    for (const network::Phase& phase : scene.arm_setup(i).script) {
      const double rate = std::abs(phase.lever_rate);
      if (rate > added.max_lever_rate) added.max_lever_rate = rate;
    }
    for (const scene::Module& module : scene.arm_setup(i).network.modules) {
      const auto* ball = std::any_cast<network::SpaceballOptions>(&module.options);
      if (ball == nullptr) continue;
      added.max_speed = ball->saturation;
      added.max_turn = ball->angular_saturation;
    }
    note_inputs(scene.arm_setup(i).network, added);
  }
  return info;
}

/// @throws SetupError if `self` has no folder
visual::TlsFiles tls_of(const SessionOptions& session) {
  if (session.tls != "self") {
    const std::size_t comma = session.tls.find(',');
    return {session.tls.substr(0, comma), session.tls.substr(comma + 1)};
  }
  // NOLINTBEGIN(concurrency-mt-unsafe): nothing sets the environment
  const char* const state = std::getenv("XDG_STATE_HOME");
  const char* const home = std::getenv("HOME");
  // NOLINTEND(concurrency-mt-unsafe)
  if (state != nullptr && *state == '/') return visual::own_certificate(state + "/repel"s);
  if (home != nullptr && *home == '/')
    return visual::own_certificate(home + "/.local/state/repel"s);
  throw SetupError(
      "--tls self keeps its certificate below $XDG_STATE_HOME or $HOME; set one of them");
}

class ServedView final : public View {
 public:
  ServedView(const visual::SceneInfo& info, const World& world, Tap& tap, Controls& controls,
             const SessionOptions& session, const std::string& device)
      : served_(info, world, tap, controls, options_of(session, device, controls)) {
    const bool is_own = session.tls == "self";
    announce(session, served_.url(), is_own ? visual::fingerprint_of(tls_of(session)) : "");
    open_browser(served_.url(), session.open);
  }

 private:
  static visual::ViewOptions options_of(const SessionOptions& session, const std::string& device,
                                        const Controls& controls) {
    const Place place = place_of(session.listen).value_or(Place{});
    visual::ViewOptions options;
    options.pages_drive = !session.view_only &&
                          (device.empty() || session.page_drives || !controls.no_driving.empty());
    options.master = device;
    options.page = session.page;
    options.server.address = place.address;
    options.server.port = place.port;
    options.server.secret = session.secret;
    if (!session.tls.empty()) options.server.tls = tls_of(session);
    return options;
  }

  visual::RunView served_;
};

}  // namespace

std::unique_ptr<View> open_view(const PreparedRun& prepared, const Heading& heading, bool is_replay,
                                Tap& tap, Controls& controls, const SessionOptions& session,
                                const std::string& device) {
  visual::SceneInfo info = scene_info_of(prepared, heading, is_replay);
  add_visuals(prepared, info);
  if (!controls.no_conduct.empty()) info.spare.clear();
  return std::make_unique<ServedView>(info, prepared.cell.world(), tap, controls, session, device);
}

}  // namespace repel::runs

#else

namespace repel::runs {

std::unique_ptr<View> open_view(const PreparedRun& /*prepared*/, const Heading& /*heading*/,
                                bool /*is_replay*/, Tap& /*tap*/, Controls& /*controls*/,
                                const SessionOptions& /*session*/, const std::string& /*device*/) {
  throw SetupError(
      "the live view is not built in; to have it: apt-get install libboost-dev libssl-dev");
}

}  // namespace repel::runs

#endif

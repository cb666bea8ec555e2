// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <repel/base/setup_error.hpp>
#include <repel/loop/columns.hpp>
#include <repel/reduction/shape_mesh.hpp>
#include <repel/visual/messages.hpp>

#include "arm_inputs.hpp"
#include "json_text.hpp"

namespace repel::visual {
namespace {

using Json = nlohmann::json;

/// @param places decimal places of one: 1e6 for six
Json vertices_of(const TriangleMesh& mesh, double places) {
  Json vertices = Json::array();
  for (const Vec3& p : mesh.vertices) {
    for (const double x : p) vertices.push_back(std::round(places * x) / places);
  }
  return vertices;
}

Json triangles_of(const TriangleMesh& mesh) {
  Json triangles = Json::array();
  for (const auto& triangle : mesh.triangles) {
    for (const int vertex : triangle) triangles.push_back(vertex);
  }
  return triangles;
}

Json levels_of(const Shape& shape) {
  Json levels = Json::array();
  for (int i = 0; i < shape.levels(); ++i) {
    const TriangleMesh mesh = mesh_of(shape, i);
    // The depth of the first level is its rounding radius, which its mesh includes.
    levels.push_back({{"depth_m", i == 0 ? 0.0 : rounded(shape.level(i).depth)},
                      {"vertices", vertices_of(mesh, 1e6)},
                      {"triangles", triangles_of(mesh)}});
  }
  return levels;
}

Json to_json(const VisualInfo& info) {
  Json json{{"name", info.name},
            {"arm", info.arm},
            {"pose", visual::to_json(info.X_BV)},
            {"vertices", vertices_of(info.mesh, 1e5)},  // many, and nobody sees more
            {"triangles", triangles_of(info.mesh)}};
  if (info.link < 0) {
    json["body"] = info.body.index;
  } else {
    json["link"] = info.link;
  }
  if (info.color) json["color"] = *info.color;
  return json;
}

/// The links of an arm that look like something and have no body, each once, base outward.
std::set<int> placed_links(const SceneInfo& info, std::size_t arm) {
  std::set<int> links;
  for (const VisualInfo& each : info.visuals) {
    if (each.link >= 0 && each.arm == static_cast<int>(arm)) links.insert(each.link);
  }
  return links;
}

/// @throws SetupError if nobody could say where a visual is
void check(const SceneInfo& info, const VisualInfo& visual) {
  if (visual.link < 0) return;
  const bool has_arm = visual.arm >= 0 && visual.arm < std::ssize(info.arms);
  const ArmInfo none;
  const ArmInfo& arm = has_arm ? info.arms[static_cast<std::size_t>(visual.arm)] : none;
  if (visual.link < std::ssize(arm.joints) && arm.kinematics != nullptr) return;
  throw SetupError("the visual '" + visual.name + "' moves with link " +
                   std::to_string(visual.link) + " of arm " + std::to_string(visual.arm) + ", of " +
                   std::to_string(info.arms.size()) + ", which has " +
                   std::to_string(arm.joints.size()) + " joints and " +
                   (arm.kinematics != nullptr ? "" : "no ") + "kinematics");
}

/// The owner of a body: arm index and "tool" or "link"; for none, -1 and "obstacle".
std::pair<int, const char*> owner_of(const SceneInfo& info, BodyId body) {
  for (std::size_t i = 0; i < info.arms.size(); ++i) {
    const ArmInfo& arm = info.arms[i];
    if (arm.tool == body) return {static_cast<int>(i), "tool"};
    if (std::count(arm.links.begin(), arm.links.end(), body) > 0)
      return {static_cast<int>(i), "link"};
  }
  return {-1, "obstacle"};
}

/// Adds the greatest range of the laws under which a part acts on others, and whether it is
/// passable: all of these laws are. What may not enter it meets a wall.
void add_laws(const World& world, std::int32_t part, Json& json) {
  double range = 0.0;
  int pairs = 0;
  int passable = 0;
  for (const Pair& pair : world.pairs()) {
    if (pair.b.index != part) continue;
    range = std::max(range, pair.law.range);
    ++pairs;
    passable += pair.law.passable ? 1 : 0;
  }
  json["range_m"] = range;
  json["passable"] = pairs > 0 && passable == pairs;
}

/// The laws of the pairs, each once, and by pair its place among them.
std::pair<Json, std::vector<std::size_t>> laws_of(const World& world) {
  using Key = std::tuple<double, double, double, double, bool, bool>;
  std::map<Key, std::size_t> known;
  Json laws = Json::array();
  std::vector<std::size_t> places;
  for (const Pair& pair : world.pairs()) {
    const ForceLaw& law = pair.law;
    const bool is_hard = law.hold == HoldKind::hard;
    const Key key{law.range, law.surface_force, law.damping, law.ceiling, law.passable, is_hard};
    const auto [place, is_new] = known.try_emplace(key, known.size());
    places.push_back(place->second);
    if (!is_new) continue;
    laws.push_back({{"range_m", law.range},
                    {"surface_force_n", law.surface_force},
                    {"damping_ns_m", law.damping},
                    {"passable", law.passable},
                    {"hard", is_hard}});
    if (std::isfinite(law.ceiling)) laws.back()["ceiling_n"] = law.ceiling;
  }
  return {std::move(laws), std::move(places)};
}

/// null where it is not known or there is none.
Json limit(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// The joints of an arm by name, with their ends, greatest rates and torques.
void add_joints(const ArmInfo& arm, Json& json) {
  for (const ArmLink& link : arm.links_of_model) {
    const auto known = [](double most) { return most > 0.0 ? limit(most) : Json(nullptr); };
    json["limits"].push_back({{"name", link.joint_name},
                              {"lower", limit(link.lower)},
                              {"upper", limit(link.upper)},
                              {"rate", known(link.velocity_limit)},
                              {"effort", known(link.effort_limit)}});
  }
}

std::vector<JointType> types_of(const ArmInfo& arm) {
  std::vector<JointType> types;
  for (const std::string& joint : arm.joints) {
    types.push_back(joint == "revolute" ? JointType::revolute : JointType::prismatic);
  }
  return types;
}

/// The names of what `write_signals` writes, as in a CSV log.
Json signals_of(const ArmInfo& arm) {
  const std::vector<JointType> types = types_of(arm);
  const ColumnNames names{types, arm.modules};
  Json signals = Json::array();
  const TickRecord none;
  for_each_field(
      [&]<class Value>(const TickField& field, const Value& /*x*/) {
        if constexpr (!std::is_integral_v<Value> && !std::is_enum_v<Value>) {
          for (std::string& name : names.of<Value>(field)) signals.push_back(std::move(name));
        }
      },
      none);
  return signals;
}

void write_signals(const ArmInfo& arm, const TickRecord& k, JsonText& out) {
  out.name("signals").open('[');
  for_each_value(k, arm.joints.size(), arm.modules.size(), [&out]<class Value>(const Value& x) {
    if constexpr (std::is_floating_point_v<Value>) out.number(double{x});
  });
  out.close(']');
}

/// What hard walls hold, if one is near.
void write_hold(const TickRecord& k, JsonText& out) {
  if (!k.hold.pair.valid()) return;
  out.name("hold").open('{').name("pair").integer(k.hold.pair.index);
  out.name("margin_m").number(k.hold.margin).name("force_n").number(k.held_force);
  out.close('}');
}

double us(std::chrono::nanoseconds time) {
  return static_cast<double>(time.count()) / 1e3;
}

void write(const NearPair& near, JsonText& out) {
  const Separation& s = near.separation;
  out.open('{');
  out.name("i").integer(near.pair.index).name("d").number(s.distance);
  out.name("lower").number(s.lower).name("upper").number(s.upper);
  out.name("a").vector(s.p_WA).name("b").vector(s.p_WB).name("n").vector(s.extraction_W);
  out.name("level").integer(s.level).name("f").number(near.force);
  out.name("stale").boolean(near.stale).name("age").integer(near.age);
  out.close('}');
}

/// Where these links of an arm are, if there are any.
void write_links(const ArmInfo& info, const std::set<int>& links, const TickRecord& k,
                 JsonText& out) {
  if (links.empty()) return;
  info.kinematics->update(std::span(k.q).first(info.joints.size()));
  out.name("links").open('[');
  for (const int link : links) out.pose(info.kinematics->X_WL(link));
  out.close(']');
}

void write(const ArmInfo& info, const std::set<int>& links, const TickRecord& k, JsonText& out) {
  out.open('{');
  out.name("force").vector(k.virtual_force.force).name("torque").vector(k.virtual_force.torque);
  out.name("coupling").vector(k.coupling.force).name("lever_nm").number(k.lever_torque);
  out.name("gain").number(k.gain).name("v").vector(k.v_WT).name("q").open('[');
  for (std::size_t i = 0; i < info.joints.size(); ++i) out.number(k.q[i]);
  out.close(']').name("energy_j").open('[');
  for (std::size_t i = 0; i < info.modules.size(); ++i) out.number(k.energy[i]);
  write_inputs(info, k, out.close(']'));
  write_links(info, links, k, out);
  write_signals(info, k, out);
  write_hold(k, out);
  out.close('}');
}

/// Whether an arm has a script.
bool is_scripted(const SceneInfo& info) {
  return std::any_of(info.arms.begin(), info.arms.end(),
                     [](const ArmInfo& arm) { return !arm.phases.empty(); });
}

/// Whether there is a script, and those of all arms have ended. The name of the phase does not
/// tell: a phase need not have one.
bool is_over(const SceneInfo& info, const Snapshot& shot) {
  for (std::size_t i = 0; i < info.arms.size(); ++i) {
    if (static_cast<std::size_t>(shot.arms[i].phase) < info.arms[i].phases.size()) return false;
  }
  return is_scripted(info);
}

void write(Status status, JsonText& out) {
  out.open('[');
  for (unsigned bit = 0; bit < 32; ++bit) {
    if ((status >> bit & 1U) != 0U) out.json(Json(to_text(1U << bit)).dump());
  }
  out.close(']');
}

/// The bodies that are not there, if there are any.
void write_absent(const Snapshot& shot, JsonText& out) {
  if (std::count(shot.is_there.begin(), shot.is_there.end(), 0) == 0) return;
  out.name("absent").open('[');
  for (std::size_t i = 0; i < shot.is_there.size(); ++i) {
    if (shot.is_there[i] == 0) out.integer(static_cast<std::int64_t>(i));
  }
  out.close(']');
}

/// Writes an array of f(sample).
template <class F>
void write(const char* name, std::span<const TickSample> samples, const F& f, JsonText& out) {
  out.name(name).open('[');
  for (const TickSample& sample : samples) out.number(f(sample));
  out.close(']');
}

/// The status of the first of them, and of each at which it differs from the one before.
void write_changes(std::span<const TickSample> samples, JsonText& out) {
  out.name("status").open('[');
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i > 0 && samples[i].status == samples[i - 1].status) continue;
    out.open('[').integer(samples[i].tick);
    write(samples[i].status, out);
    out.close(']');
  }
  out.close(']');
}

void write(std::span<const TickSample> samples, JsonText& out) {
  using Sample = const TickSample&;
  out.open('{').name("tick").open('[');
  for (Sample sample : samples) out.integer(sample.tick);
  out.close(']');
  write(
      "nearest_m", samples, [](Sample each) { return each.nearest; }, out);
  write(
      "force_n", samples, [](Sample each) { return each.force; }, out);
  write(
      "compute_us", samples, [](Sample each) { return us(each.times.compute); }, out);
  write(
      "late_us", samples, [](Sample each) { return us(each.times.late); }, out);
  write_changes(samples, out);
  out.close('}');
}

}  // namespace

std::string scene_message(const SceneInfo& info, const World& world) {
  Json bodies = Json::array();
  for (int i = 0; i < world.body_count(); ++i) bodies.push_back(world.body_name({i}));
  Json parts = Json::array();
  for (std::size_t i = 0; i < world.parts().size(); ++i) {
    const Part& part = world.parts()[i];
    const auto [arm, group] = owner_of(info, part.body);
    Json json{{"name", part.name}, {"body", part.body.index},    {"group", group},
              {"arm", arm},        {"pose", to_json(part.X_BP)}, {"levels", levels_of(part.shape)}};
    add_laws(world, static_cast<std::int32_t>(i), json);
    parts.push_back(std::move(json));
  }
  auto [laws, places] = laws_of(world);
  Json pairs = Json::array();
  for (std::size_t i = 0; i < world.pairs().size(); ++i) {
    const Pair& pair = world.pairs()[i];
    pairs.push_back({pair.a.index, pair.b.index, pair.law.range, places[i]});
  }
  for (const GapsInfo& gaps : info.gaps) {
    Json& json = parts.at(static_cast<std::size_t>(gaps.part.index));
    json["gap_count"] = gaps.count;
    for (const GapsInfo::Gap& gap : gaps.deepest) {
      json["gaps"].push_back(
          {rounded(gap.p_P.x()), rounded(gap.p_P.y()), rounded(gap.p_P.z()), rounded(gap.depth)});
    }
  }
  for (const LookInfo& look : info.looks) {
    Json& json = parts.at(static_cast<std::size_t>(look.part.index));
    if (!look.of.empty()) json["of"] = look.of;
    if (look.color) json["color"] = *look.color;
    if (look.opacity) json["opacity"] = *look.opacity;
  }
  Json arms = Json::array();
  for (const VisualInfo& each : info.visuals) check(info, each);
  for (std::size_t i = 0; i < info.arms.size(); ++i) {
    const ArmInfo& arm = info.arms[i];
    arms.push_back({{"name", arm.name},
                    {"joints", arm.joints},
                    {"modules", arm.modules},
                    {"tool_body", arm.tool.index},
                    {"max_speed_m_s", arm.max_speed},
                    {"max_turn_rad_s", arm.max_turn},
                    {"max_lever_rad_s", arm.max_lever_rate},
                    {"signals", signals_of(arm)}});
    add_joints(arm, arms.back());
    add_inputs(arm, arms.back());
    const std::set<int> links = placed_links(info, i);
    if (!links.empty()) arms.back()["links"] = links;
  }
  Json scene{{"type", "scene"},
             {"version", 1},
             {"name", info.scene},
             {"rate_hz", info.rate_hz},
             {"period_us", 1e6 / info.rate_hz},
             {"mode", info.replay ? "replay" : "live"},
             {"duration_s", info.duration},
             {"bodies", std::move(bodies)},
             {"parts", std::move(parts)},
             {"pairs", std::move(pairs)},
             {"laws", std::move(laws)},
             {"arms", std::move(arms)}};
  if (is_scripted(info)) scene["scripted"] = true;
  for (const PartId id : info.spare) scene["spare"].push_back(id.index);
  for (const VisualInfo& each : info.visuals) scene["visuals"].push_back(to_json(each));
  return scene.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string part_message(PartId id, const Shape& shape) {
  return Json{{"type", "part"}, {"part", id.index}, {"levels", levels_of(shape)}}.dump();
}

std::string parts_message(const std::map<std::int32_t, Shape>& shapes) {
  Json parts = Json::array();
  for (const auto& [part, shape] : shapes) {
    parts.push_back({{"part", part}, {"levels", levels_of(shape)}});
  }
  return Json{{"type", "parts"}, {"parts", parts}}.dump();
}

std::string depth_message(const std::string& camera, const DepthView& view) {
  const Json json{{"type", "depth"},
                  {"camera", camera},
                  {"width", view.width},
                  {"height", view.height},
                  {"mm", view.depth}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string frame_message(const SceneInfo& info, const World& world, const Snapshot& shot,
                          std::span<const TickSample> recent, bool running) {
  const TickRecord& first = shot.arms.front();
  const auto phase = static_cast<std::size_t>(first.phase);
  const std::vector<std::string>& phases = info.arms.front().phases;
  const std::string name = phase < phases.size() ? phases[phase] : "";
  Status status = 0;
  for (std::size_t i = 0; i < info.arms.size(); ++i) status |= shot.arms[i].status;
  JsonText out;
  out.open('{').name("type").json("\"frame\"").name("tick").integer(first.tick);
  out.name("time_s").number(first.time).name("running").boolean(running);
  out.name("phase").json(Json(name).dump(-1, ' ', false, Json::error_handler_t::replace));
  if (is_over(info, shot)) out.name("script_over").boolean(true);
  write(status, out.name("status"));
  out.name("bodies").open('[');
  for (const Pose& X : shot.X_WB) out.pose(X);
  out.close(']');
  write_absent(shot, out);
  out.name("pairs").open('[');
  for (const NearPair& near : shot.near()) write(near, out);
  out.close(']').name("pairs_omitted").integer(shot.pairs_omitted);
  out.name("near").integer(first.pairs.near).name("evaluated").integer(first.pairs.evaluated);
  out.name("of").integer(std::ssize(world.pairs())).name("arms").open('[');
  for (std::size_t i = 0; i < info.arms.size(); ++i) {
    write(info.arms[i], placed_links(info, i), shot.arms[i], out);
  }
  write(recent, out.close(']').name("recent"));
  out.close('}');
  return std::move(out).take();
}

const std::vector<double>& Timing::edges() {
  static const std::vector<double> all = [] {
    std::vector<double> edges;
    for (int tenth = -10; tenth <= 50; ++tenth) edges.push_back(std::pow(10.0, 0.1 * tenth));
    return edges;
  }();
  return all;
}

Timing::Timing() : compute_bins(edges().size() - 1, 0), late_bins(compute_bins) {}

void Timing::add(const TickTimes& times, std::chrono::nanoseconds period) {
  const auto count = [](double value, std::vector<std::int64_t>& bins) {
    const auto above = std::upper_bound(edges().begin() + 1, edges().end() - 1, value);
    ++bins[static_cast<std::size_t>(above - edges().begin() - 1)];
  };
  compute.record(times.compute);
  late.record(times.late);
  count(us(times.compute), compute_bins);
  count(us(times.late), late_bins);
  ++ticks;
  misses += times.late + times.compute > period ? 1 : 0;
}

std::string timing_message(const Timing& timing) {
  const auto summary = [](const DurationHistogram& times) {
    return Json{{"p50", times.percentile_us(0.5)},
                {"p99", times.percentile_us(0.99)},
                {"max", times.max_us()}};
  };
  return Json{{"type", "timing"},
              {"edges_us", Timing::edges()},
              {"compute", timing.compute_bins},
              {"late", timing.late_bins},
              {"ticks", timing.ticks},
              {"misses", timing.misses},
              {"dropped", timing.dropped},
              {"compute_us", summary(timing.compute)},
              {"late_us", summary(timing.late)}}
      .dump();
}

void is_built_for(EigenAlignmentHere /*alignment*/, VectorRegisterHere /*size*/) noexcept {}

}  // namespace repel::visual

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include <repel/visual/messages.hpp>

#include "mesh.hpp"

namespace repel::visual {
namespace {

using Json = nlohmann::json;

/// To a micrometre, a microradian: what nobody can see would make half of the text.
double rounded(double value) {
  return std::round(1e6 * value) / 1e6;
}

/// null for what is not finite.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json to_json(const Vec3& v) {
  return {rounded(v.x()), rounded(v.y()), rounded(v.z())};
}

Json to_json(const Pose& X) {
  const Vec3 p = X.translation();
  const Eigen::Quaterniond q(X.linear());
  return {rounded(p.x()), rounded(p.y()), rounded(p.z()), rounded(q.x()),
          rounded(q.y()), rounded(q.z()), rounded(q.w())};
}

Json levels_of(const Shape& shape) {
  Json levels = Json::array();
  for (int i = 0; i < shape.levels(); ++i) {
    const Mesh mesh = mesh_of(shape, i);
    Json vertices = Json::array();
    Json triangles = Json::array();
    for (const Vec3& p : mesh.vertices) {
      for (const double x : p) vertices.push_back(rounded(x));
    }
    for (const auto& triangle : mesh.triangles) {
      for (const int vertex : triangle) triangles.push_back(vertex);
    }
    // The depth of the first level is rounding, which its mesh has around it.
    levels.push_back({{"depth_m", i == 0 ? 0.0 : rounded(shape.level(i).depth)},
                      {"vertices", std::move(vertices)},
                      {"triangles", std::move(triangles)}});
  }
  return levels;
}

/// Whose a body is: the number of the arm, and "tool", "link" or, of none, "obstacle".
std::pair<int, const char*> owner_of(const Cast& cast, BodyId body) {
  for (std::size_t i = 0; i < cast.arms.size(); ++i) {
    const ArmCast& arm = cast.arms[i];
    if (arm.tool == body) return {static_cast<int>(i), "tool"};
    if (std::count(arm.links.begin(), arm.links.end(), body) > 0)
      return {static_cast<int>(i), "link"};
  }
  return {-1, "obstacle"};
}

/// What the laws of the pairs say of a part: how far it is felt, and if all of them let it pass.
void add_laws(const World& world, std::int32_t part, Json& json) {
  double range = 0.0;
  bool passable = false;
  for (const Pair& pair : world.pairs()) {
    if (pair.b.index != part) continue;
    range = std::max(range, pair.law.range);
    passable = pair.law.passable;
  }
  json["range_m"] = range;
  json["passable"] = passable;
}

Json to_json(const NearPair& near) {
  const Separation& s = near.separation;
  return {{"i", near.pair.index},         {"d", rounded(s.distance)}, {"lower", number(s.lower)},
          {"upper", number(s.upper)},     {"a", to_json(s.p_WA)},     {"b", to_json(s.p_WB)},
          {"n", to_json(s.extraction_W)}, {"level", s.level},         {"f", rounded(near.force)},
          {"stale", near.stale},          {"age", near.age}};
}

Json arm_frame(const ArmCast& cast, const TickRecord& k) {
  Json q = Json::array();
  for (std::size_t i = 0; i < cast.joints.size(); ++i) q.push_back(rounded(k.q[i]));
  Json energy = Json::array();
  for (std::size_t i = 0; i < cast.modules.size(); ++i) energy.push_back(number(k.energy[i]));
  return {{"force", to_json(k.virtual_force.force)},
          {"torque", to_json(k.virtual_force.torque)},
          {"coupling", to_json(k.coupling.force)},
          {"lever_nm", rounded(k.lever_torque)},
          {"gain", rounded(k.gain)},
          {"v", to_json(k.v_WT)},
          {"q", std::move(q)},
          {"energy_j", std::move(energy)}};
}

Json status_of(Status status) {
  Json names = Json::array();
  for (unsigned bit = 0; bit < 32; ++bit) {
    if ((status >> bit & 1U) != 0U) names.push_back(to_text(1U << bit));
  }
  return names;
}

double us(std::chrono::nanoseconds time) {
  return static_cast<double>(time.count()) / 1e3;
}

Json recent_of(std::span<const TickSample> samples) {
  Json tick = Json::array();
  Json nearest = tick;
  Json force = tick;
  Json compute = tick;
  Json late = tick;
  for (const TickSample& sample : samples) {
    tick.push_back(sample.tick);
    nearest.push_back(number(rounded(sample.nearest)));
    force.push_back(rounded(sample.force));
    compute.push_back(us(sample.times.compute));
    late.push_back(us(sample.times.late));
  }
  return {{"tick", std::move(tick)},
          {"nearest_m", std::move(nearest)},
          {"force_n", std::move(force)},
          {"compute_us", std::move(compute)},
          {"late_us", std::move(late)}};
}

}  // namespace

std::string scene_message(const Cast& cast, const World& world) {
  Json bodies = Json::array();
  for (int i = 0; i < world.body_count(); ++i) bodies.push_back(world.body_name({i}));
  Json parts = Json::array();
  for (std::size_t i = 0; i < world.parts().size(); ++i) {
    const Part& part = world.parts()[i];
    const auto [arm, group] = owner_of(cast, part.body);
    Json json{{"name", part.name}, {"body", part.body.index},    {"group", group},
              {"arm", arm},        {"pose", to_json(part.X_BP)}, {"levels", levels_of(part.shape)}};
    add_laws(world, static_cast<std::int32_t>(i), json);
    parts.push_back(std::move(json));
  }
  Json pairs = Json::array();
  for (const Pair& pair : world.pairs()) {
    pairs.push_back({pair.a.index, pair.b.index, pair.law.range});
  }
  Json arms = Json::array();
  for (const ArmCast& arm : cast.arms) {
    arms.push_back({{"name", arm.name},
                    {"joints", arm.joints},
                    {"modules", arm.modules},
                    {"tool_body", arm.tool.index},
                    {"max_speed_m_s", arm.max_speed},
                    {"max_turn_rad_s", arm.max_turn}});
  }
  return Json{{"type", "scene"},
              {"version", 1},
              {"name", cast.scene},
              {"rate_hz", cast.rate_hz},
              {"period_us", 1e6 / cast.rate_hz},
              {"mode", cast.replay ? "replay" : "live"},
              {"duration_s", cast.duration},
              {"bodies", std::move(bodies)},
              {"parts", std::move(parts)},
              {"pairs", std::move(pairs)},
              {"arms", std::move(arms)}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string frame_message(const Cast& cast, const World& world, const Snapshot& shot,
                          std::span<const TickSample> recent, bool running) {
  const TickRecord& first = shot.arms.front();
  Json bodies = Json::array();
  for (const Pose& X : shot.X_WB) bodies.push_back(to_json(X));
  Json pairs = Json::array();
  for (const NearPair& near : shot.near()) pairs.push_back(to_json(near));
  Json arms = Json::array();
  Status status = 0;
  for (std::size_t i = 0; i < cast.arms.size(); ++i) {
    arms.push_back(arm_frame(cast.arms[i], shot.arms[i]));
    status |= shot.arms[i].status;
  }
  const auto phase = static_cast<std::size_t>(first.phase);
  const std::vector<std::string>& phases = cast.arms.front().phases;
  return Json{{"type", "frame"},
              {"tick", first.tick},
              {"time_s", first.time},
              {"running", running},
              {"phase", phase < phases.size() ? phases[phase] : ""},
              {"status", status_of(status)},
              {"bodies", std::move(bodies)},
              {"pairs", std::move(pairs)},
              {"pairs_omitted", shot.pairs_omitted},
              {"near", first.pairs.near},
              {"evaluated", first.pairs.evaluated},
              {"of", world.pairs().size()},
              {"arms", std::move(arms)},
              {"recent", recent_of(recent)}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
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

}  // namespace repel::visual

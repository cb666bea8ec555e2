// SPDX-License-Identifier: BSD-3-Clause
#include <repel/devices/haply_messages.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <exception>
#include <vector>

#ifdef REPEL_HAS_HAPLY
#include <nlohmann/json.hpp>

#include <repel/common/json_fields.hpp>
#endif

namespace repel::devices {
namespace {

bool is_alphanumeric(char c) noexcept {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

#ifdef REPEL_HAS_HAPLY

using Json = nlohmann::json;
using fields::member;
using fields::number;

/// The identifier is sent back in every command, so nothing in it may need an escape.
bool is_device_id(std::string_view text) noexcept {
  return !text.empty() && text.size() <= HaplyBounds::id &&
         std::all_of(text.begin(), text.end(),
                     [](char c) { return is_alphanumeric(c) || c == '-' || c == '_'; });
}

/// JSON without the same key twice in one object; discarded if it is not that.
Json parsed_haply(std::string_view text) {
  std::vector<std::vector<std::string>> open;  // the keys of each object that is being read
  bool twice = false;
  const auto watch = [&](int /*depth*/, Json::parse_event_t event, Json& value) {
    using Event = Json::parse_event_t;
    if (event == Event::object_start) open.emplace_back();
    if (event == Event::object_end && !open.empty()) open.pop_back();
    if (event == Event::key && !open.empty()) {
      std::vector<std::string>& keys = open.back();
      const auto& key = value.get_ref<const std::string&>();
      twice = twice || std::find(keys.begin(), keys.end(), key) != keys.end();
      // Nobody has so many, and each is compared with all before.
      twice = twice || keys.size() >= 256;
      if (!twice) keys.push_back(key);
    }
    return true;
  };
  Json root = Json::parse(text.begin(), text.end(), watch, false);
  return twice ? Json(Json::value_t::discarded) : root;
}

bool read_vector(const Json& object, double most, Vec3& vector) {
  const auto x = number(object, "x", most), y = number(object, "y", most);
  const auto z = number(object, "z", most);
  if (x && y && z) vector = {*x, *y, *z};
  return x && y && z;
}

/// Leaves `flag` as it is where there is no such member.
bool read_flag(const Json& object, const char* name, bool& flag) {
  const Json& value = member(object, name);
  flag = fields::value_of<bool>(value).value_or(flag);
  return value.is_boolean() || value.is_discarded();
}

/// The list of the devices of a kind: `devices` is nullptr where there are none.
bool read_list(const Json& root, const char* kind, const Json*& devices) {
  const Json& list = member(root, kind);
  devices = list.is_array() && !list.empty() ? &list : nullptr;
  return list.is_discarded() || (list.is_array() && list.size() <= HaplyBounds::devices);
}

const char* read_handle(const Json& root, HaplyState& state) {
  const Json* devices = nullptr;
  if (!read_list(root, "inverse3", devices)) return "the list of devices is none";
  if (devices == nullptr) return nullptr;
  std::vector<std::string> ids;
  for (const Json& device : *devices) {
    ids.push_back(fields::text(device, "device_id"));
    if (!is_device_id(ids.back())) return "a device has no identifier";
    if (std::find(ids.begin(), ids.end() - 1, ids.back()) != ids.end() - 1) {
      return "two devices have the same identifier";
    }
  }
  const Json& handle = devices->front();
  const Json& of_handle = member(handle, "state");
  if (!read_vector(member(of_handle, "cursor_position"), HaplyBounds::position, state.position)) {
    return "the position of the handle is missing or impossible";
  }
  if (!read_vector(member(of_handle, "cursor_velocity"), HaplyBounds::velocity, state.velocity)) {
    return "the velocity of the handle is missing or impossible";
  }
  if (!read_flag(member(handle, "status"), "calibrated", state.calibrated)) {
    return "the status of the handle is none";
  }
  state.device_id = std::move(ids.front());
  return nullptr;
}

const char* read_grip(const Json& root, HaplyState& state) {
  const Json* grips = nullptr;
  if (!read_list(root, "wireless_verse_grip", grips)) return "the list of grips is none";
  const bool is_wired = grips == nullptr;
  if (is_wired && !read_list(root, "verse_grip", grips)) return "the list of grips is none";
  if (grips == nullptr) return nullptr;
  const Json& of_grip = member(grips->front(), "state");
  const Json& orientation = member(of_grip, "orientation");
  Vec3 xyz{0, 0, 0};
  const auto w = number(orientation, "w", 1.1);
  if (!read_vector(orientation, 1.1, xyz) || !w) {
    return "the orientation of the grip is missing or impossible";
  }
  state.R_DG = Eigen::Quaterniond(*w, xyz.x(), xyz.y(), xyz.z());
  if (std::abs(state.R_DG.norm() - 1.0) > HaplyBounds::quaternion_error) {
    return "the orientation of the grip is not of length one";
  }
  state.R_DG.normalize();
  const Json& buttons = is_wired ? of_grip : member(of_grip, "buttons");
  const std::array<const char*, 3> names = is_wired ? std::array<const char*, 3>{"button", "", ""}
                                                    : std::array<const char*, 3>{"a", "b", "c"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!read_flag(buttons, names[i], state.buttons[i])) return "a button of the grip is none";
  }
  state.has_grip = true;
  return nullptr;
}

#endif

void append_number(std::string& text, double number) {
  std::array<char, 32> digits{};
  const double shown = std::abs(number) <= 1e6 ? number : 0.0;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), shown,
                                 std::chars_format::fixed, 5);
  text.append(digits.data(), end.ptr);
}

}  // namespace

const char* read_haply(std::string_view text, HaplyState& state) noexcept {
#ifdef REPEL_HAS_HAPLY
  if (text.size() > HaplyBounds::text) return "a message is too long";
  try {
    state = {};
    const Json root = parsed_haply(text);
    if (!root.is_object()) return "a message is not JSON, or says something twice";
    const char* wrong = read_handle(root, state);
    return wrong != nullptr ? wrong : read_grip(root, state);
  } catch (const std::exception&) {
    return "a message could not be read";
  }
#else
  (void)text;
  (void)state;
  return "the messages of Haply cannot be read: not built in";
#endif
}

std::string haply_command(std::string_view device_id, const Vec3& force, HaplyTurn turn) {
  std::string text = "{";
  if (turn == HaplyTurn::first) {
    text += R"("session":{"configure":{"profile":{"name":"repel"},)";
    text += R"("basis":{"permutation":"XYZ"}}})";
  }
  if (device_id.empty()) {
    // The service answers nothing but messages: this one asks whether a device has come.
    text = R"({"session":{"force_render_full_state":{}})";
  } else {
    if (turn == HaplyTurn::first) text += ',';
    text += R"("inverse3":[{"device_id":")";
    text += device_id;
    text += R"(","commands":{"set_cursor_force":{"values":{"x":)";
    append_number(text, force.x());
    text += R"(,"y":)";
    append_number(text, force.y());
    text += R"(,"z":)";
    append_number(text, force.z());
    text += "}}}}]";
  }
  text += '}';
  return text;
}

std::optional<HaplyAddress> haply_address(std::string_view url) {
  constexpr std::string_view scheme = "ws://";
  if (!url.starts_with(scheme)) return std::nullopt;
  url.remove_prefix(scheme.size());
  if (url.ends_with('/')) url.remove_suffix(1);
  HaplyAddress address;
  if (url.starts_with('[')) {
    const std::size_t end = url.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    address.host = url.substr(1, end - 1);
    url.remove_prefix(end + 1);
  } else {
    address.host = url.substr(0, url.find(':'));
    url.remove_prefix(address.host.size());
  }
  const bool has_name =
      !address.host.empty() && std::all_of(address.host.begin(), address.host.end(), [](char c) {
        return is_alphanumeric(c) || c == '.' || c == '-' || c == ':';
      });
  if (!has_name) return std::nullopt;
  if (url.empty()) return address;
  if (url.front() != ':') return std::nullopt;
  url.remove_prefix(1);
  unsigned port = 0;
  const auto read = std::from_chars(url.data(), url.data() + url.size(), port);
  if (read.ec != std::errc() || read.ptr != url.data() + url.size()) return std::nullopt;
  if (port < 1 || port > 65535) return std::nullopt;
  address.port = std::to_string(port);
  return address;
}

}  // namespace repel::devices

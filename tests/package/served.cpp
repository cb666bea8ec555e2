// SPDX-License-Identifier: BSD-3-Clause
// With the part `visual`: a program of one's own finds the page of the installed package, and
// serves it.
#ifdef PART_visual
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <memory>
#include <string>

#include <repel/visual/live_view.hpp>

namespace {

using namespace repel;

struct Rail final : ArmKinematics {
  void update(std::span<const double> q) noexcept override { x = q[0]; }
  [[nodiscard]] Pose X_WT() const noexcept override {
    return Pose(Eigen::Translation3d(x, 0.0, 0.0));
  }
  void tool_jacobian(JacobianRef J) const noexcept override {
    J.setZero();
    J(0, 0) = 1.0;
  }
  void gravity_torques(std::span<double> out) noexcept override { out[0] = 0.0; }
  double x = 0.0;
};

CellDescription rail() {
  CellDescription cell{.rate_hz = 1000.0};
  ArmDescription& arm = cell.arms.emplace_back();
  ArmLink link{.type = JointType::prismatic, .lower = -1.0, .upper = 1.0};
  link.viscous_friction = 300.0;
  link.rotor_inertia = 4.0;
  arm.model.links = {link};
  arm.kinematics = std::make_unique<Rail>();
  arm.parts.push_back({"ball", Shape::sphere(0.05)});
  cell.obstacles.push_back(
      {"wall", Shape::box({0.1, 1.0, 1.0}), Pose(Eigen::Translation3d(0.35, 0.0, 0.0))});
  return cell;
}

/// The first line of the answer to a browser that asks for the page.
std::string answer_of(const std::string& url) {
  const std::string place = url.substr(7, url.size() - 8);  // between http:// and /
  const int line = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port =
      htons(static_cast<std::uint16_t>(std::stoi(place.substr(place.find(':') + 1))));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  std::string answer(15, '\0');
  if (::connect(line, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    const std::string request = "GET / HTTP/1.1\r\nHost: " + place + "\r\n\r\n";
    (void)::send(line, request.data(), request.size(), 0);
    (void)::recv(line, answer.data(), answer.size(), MSG_WAITALL);
  }
  ::close(line);
  return answer;
}

}  // namespace

bool page_is_served();
bool page_is_served() {
  Cell cell(rail());
  visual::ViewOptions options;
  options.server.port = 0;
  visual::LiveView view(cell, visual::scene_info_of(cell, "rail"), options);
  const double still[1] = {0.0};
  view.show(cell.step({still, still}, {}, cell.period()), {});
  return answer_of(view.url()) == "HTTP/1.1 200 OK";
}
#endif

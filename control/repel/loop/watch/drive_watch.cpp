// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/watch/drive_watch.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace repel {

DriveWatch::DriveWatch(const ArmModel& model, double delay)
    : model_(model),
      delay_(delay),
      ring_(static_cast<std::size_t>(std::ceil(delay)) + late[lates - 1] + 2),
      joints_(model.links.size()) {
  for (Vector& w : ring_) w.setZero(static_cast<Eigen::Index>(joints_.size()));
  sent_ = weight_ = ring_.front();
}

void DriveWatch::note_sent(const Vector& net, std::span<const double> weight) noexcept {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    weight_.coeffRef(index(i)) = weight[i];
    sent_.coeffRef(index(i)) = net.coeff(index(i)) + weight[i];
  }
}

void DriveWatch::step(const std::vector<double>& last, const std::vector<double>& v,
                      const ArmInertia::Matrix& M, double elapsed,
                      const JointWatchOptions& options) noexcept {
  const double kept = 1.0 - std::min(1.0, elapsed / memory);
  advance(kept, elapsed);
  const double* row = M.data();  // M is symmetric
  double fastest = 0.0;          // [rad/s]
  for (const double rate : v) fastest = std::max(fastest, std::abs(rate));
  strays_ = false;
  for (std::size_t i = 0; i < joints_.size(); ++i, row += v.size()) {
    Joint& joint = joints_[i];
    const ArmLink& link = model_.links[i];
    double change = 0.0;
    double turning = 0.0;  // [N m] at most about so much is added by velocities alone
    for (std::size_t k = 0; k < v.size(); ++k) {
      change += row[k] * (v[k] - last[k]);
      turning += std::abs(row[k] * v[k]) * fastest;
    }
    const double mean = 0.5 * (v[i] + last[i]);
    const double clear = 0.1 * options.rate_noise;
    const double sign = std::clamp(mean / clear, -1.0, 1.0);
    const double friction = link.viscous_friction * mean + link.coulomb_friction * sign;
    const double others = change / elapsed + friction + weight_.coeff(index(i));
    if (std::abs(mean) > clear) {
      const double sent = (w(0.0, i) - kept * w(1.0, i)) / elapsed;
      joint.steady += std::min(1.0, elapsed / steadily) * (others - sent - joint.steady);
      const double added = elapsed * (others - joint.steady);
      joint.p = kept * joint.p + added;
      const double rubbed = link.coulomb_friction + 0.5 * link.viscous_friction * std::abs(mean);
      joint.noise = 0.1 * row[i] * options.rate_noise + memory * (rubbed + 0.5 * turning);
      compare(i, std::min(1.0, elapsed / window), options);
      follow(joint, added, elapsed * sent, w(0.0, i), elapsed, options);
    } else {
      rest(i);  // friction may hold it
    }
    strays_ = strays_ || joint.ticks >= enough;
  }
}

void DriveWatch::begin_anew(double elapsed) noexcept {
  advance(1.0 - std::min(1.0, elapsed / memory), elapsed);
  for (std::size_t i = 0; i < joints_.size(); ++i) rest(i);
  strays_ = false;
}

double DriveWatch::left_of(double p, double w, double u) noexcept {
  return std::abs(p - std::clamp(p, std::min(w / u, w * u), std::max(w / u, w * u)));
}

void DriveWatch::Since::add(double added, double sent, double u) noexcept {
  p += added;
  w += sent;
  told = std::max(told, left_of(p, w, u));
  none = std::max(none, std::abs(p));
  for (std::size_t k = 0; k < 3; ++k) {
    opposite[k] = std::max(opposite[k], std::abs(p + opposites[k] * w));
  }
}

void DriveWatch::advance(double kept, double elapsed) noexcept {
  const Vector& before = ring_[newest_];
  newest_ = (newest_ + 1) % ring_.size();
  ring_[newest_] = kept * before + elapsed * sent_;
}

double DriveWatch::at(std::size_t ticks, std::size_t joint) const noexcept {
  return ring_[(newest_ + ring_.size() - ticks) % ring_.size()].coeff(index(joint));
}

double DriveWatch::w(double later, std::size_t joint) const noexcept {
  const double ticks = delay_ + later;
  const auto whole = static_cast<std::size_t>(ticks);
  const double rest = ticks - static_cast<double>(whole);
  const double a = at(whole, joint);
  return rest > 0.0 ? a + rest * (at(whole + 1, joint) - a) : a;
}

void DriveWatch::rest(std::size_t i) noexcept {
  const double steady = joints_[i].steady;
  joints_[i] = {};
  joints_[i].steady = steady;
  joints_[i].p = w(0.0, i);
}

double DriveWatch::unexplained(double pp, const Fit& fit, double u) noexcept {
  const double best = fit.ww > 0.0 ? fit.pw / fit.ww : 1.0;
  const double gain = std::clamp(best, 1.0 / u, u);
  return std::max(0.0, pp - 2.0 * gain * fit.pw + gain * gain * fit.ww);
}

void DriveWatch::compare(std::size_t i, double share, const JointWatchOptions& options) noexcept {
  Joint& joint = joints_[i];
  const auto add = [&](double& sum, double x) { sum += share * (x - sum); };
  const auto fit = [&](Fit& f, double x) {
    add(f.pw, joint.p * x);
    add(f.ww, x * x);
  };
  add(joint.pp, joint.p * joint.p);
  fit(joint.told, w(0.0, i));
  for (std::size_t k = 0; k < lates; ++k) {
    fit(joint.later[k], w(static_cast<double>(late[k]), i));
  }
  const double u = friction_error * options.mass_uncertainty;
  const double left = unexplained(joint.pp, joint.told, u);
  const double noise = joint.noise * joint.noise;
  bool is_late = false;
  for (const Fit& f : joint.later) {
    is_late = is_late || unexplained(joint.pp, f, options.mass_uncertainty) < clearly * left;
  }
  // There is a motion, and it is not explained otherwise.
  is_late = is_late && joint.pp > 4.0 * noise && left > noise;
  joint.ticks = is_late ? joint.ticks + 1 : 0;
}

void DriveWatch::follow(Joint& joint, double added, double sent, double w, double elapsed,
                        const JointWatchOptions& options) noexcept {
  const double u = friction_error * options.mass_uncertainty;
  const double left = left_of(joint.p, w, u);
  Since& since = joint.since;
  if (left < (since.time > 0.0 ? 0.5 : 1.0) * joint.noise) since = {};
  if (left >= joint.noise && since.time == 0.0) {
    for (std::size_t k = 0; k < lead; ++k) {
      const std::size_t at = (joint.oldest + k) % lead;
      since.add(joint.added[at], joint.sent[at], u);
    }
  }
  joint.added[joint.oldest] = added;
  joint.sent[joint.oldest] = sent;
  joint.oldest = (joint.oldest + 1) % lead;
  if (left < joint.noise && since.time == 0.0) return;
  since.time += elapsed;
  since.add(added, sent, u);
  if (since.time > at_first || since.told < evident * joint.noise) return;
  const double least =
      std::min({since.none, since.opposite[0], since.opposite[1], since.opposite[2]});
  if (least < beside * since.told) joint.ticks = std::max(joint.ticks, enough);
}

}  // namespace repel

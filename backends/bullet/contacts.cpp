// SPDX-License-Identifier: BSD-3-Clause
#include "contacts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace repel::bullet::detail {

constexpr int rows_per_point = 3;  // one outward, two tangential

Contacts::Contacts(const ArmModel& model, const SimulationOptions& options,
                   std::span<const ContactPart> parts, ContactTally& tally)
    : model_(model),
      options_(options),
      search_(model, parts),
      X_WL_(model.links.size(), Pose::Identity()),
      axis_W_(model.links.size(), Vec3::Zero()),
      rows_(rows_per_point * ContactSearch::most_touches),
      J_(model.links.size(), rows_.size()),
      response_(J_.rows(), J_.cols()),
      tally_(tally) {}

void Contacts::place_links(const Eigen::VectorXd& q) noexcept {
  Pose X_WP = model_.X_WB;
  for (std::size_t i = 0; i < X_WL_.size(); ++i) {
    const ArmLink& link = model_.links[i];
    const double position = q[static_cast<Eigen::Index>(i)];
    Pose& X_WL = X_WL_[i];
    X_WL = X_WP * link.X_PJ;
    axis_W_[i] = X_WL.linear() * link.axis_J;
    if (link.type == JointType::revolute) {
      X_WL.linear() = X_WL.linear() * Eigen::AngleAxisd(position, link.axis_J).toRotationMatrix();
    } else {
      X_WL.translation() += position * axis_W_[i];
    }
    X_WP = X_WL;
  }
}

void Contacts::find(const Eigen::VectorXd& q) noexcept {
  place_links(q);
  touches_ = search_.find(X_WL_);
  for (const Touch& touch : touches_) tally_.touch(touch.depth);
}

/// Sets a column of J: the joint torques of a unit force along `direction_W` at `p_W` on `link`.
void Contacts::set_row(int row, int link, const Vec3& p_W, const Vec3& direction_W) noexcept {
  J_.col(row).setZero();
  for (int i = 0; i <= link; ++i) {
    const auto joint = static_cast<std::size_t>(i);
    const Vec3& axis_W = axis_W_[joint];
    const Vec3 moved_W = model_.links[joint].type == JointType::revolute
                             ? Vec3(axis_W.cross(p_W - X_WL_[joint].translation()))
                             : axis_W;
    J_(i, row) = moved_W.dot(direction_W);
  }
}

void Contacts::begin(const Eigen::MatrixXd& W, const Eigen::VectorXd& v, double h) noexcept {
  h_ = h;
  const double across = 1.0 / options_.contact_damping;
  const double along = 1.0 / (options_.contact_damping + h * options_.contact_stiffness);
  int row = 0;
  for (const Touch& touch : touches_) {
    const Vec3 side_W = touch.out_W.unitOrthogonal();
    const double target = options_.contact_stiffness * touch.depth * along;
    for (const Vec3& direction_W : {touch.out_W, side_W, Vec3(touch.out_W.cross(side_W))}) {
      const bool out = row % rows_per_point == 0;
      set_row(row, touch.link, touch.p_W, direction_W);
      response_.col(row).noalias() = W * J_.col(row);
      rows_[static_cast<std::size_t>(row)] = {.direction_W = direction_W,
                                              .speed = J_.col(row).dot(v),
                                              .target = out ? target : 0.0,
                                              .softness = out ? along : across,
                                              .gain = h * J_.col(row).dot(response_.col(row))};
      ++row;
    }
  }
}

double Contacts::correct(int row, double least, double most, Eigen::VectorXd& a) noexcept {
  Row& r = rows_[static_cast<std::size_t>(row)];
  const double next = r.speed + h_ * J_.col(row).dot(a);
  const double wanted = r.force + (r.target - r.softness * r.force - next) / (r.gain + r.softness);
  const double change = std::clamp(wanted, least, most) - r.force;
  r.force += change;
  a += change * response_.col(row);
  return std::abs(change) * r.gain;
}

double Contacts::sweep(Eigen::VectorXd& a) noexcept {
  double largest_change = 0.0;
  for (int out = 0; out < rows_per_point * static_cast<int>(touches_.size());
       out += rows_per_point) {
    const double pushed = correct(out, 0.0, std::numeric_limits<double>::max(), a);
    const double most = options_.contact_friction * rows_[static_cast<std::size_t>(out)].force;
    const double first = correct(out + 1, -most, most, a);
    const double second = correct(out + 2, -most, most, a);
    largest_change = std::max({largest_change, pushed, first, second});
  }
  return largest_change;
}

void Contacts::note_forces() noexcept {
  const int last = static_cast<int>(X_WL_.size()) - 1;
  const Pose X_WT = X_WL_.back() * model_.X_LT;
  Wrench F_W;
  std::size_t row = 0;
  for (const Touch& touch : touches_) {
    for (int i = 0; i < rows_per_point; ++i, ++row) {
      if (touch.link != last) continue;
      const Vec3 force_W = rows_[row].force * rows_[row].direction_W;
      F_W += wrench_of_force(force_W, touch.p_W - X_WT.translation());
    }
  }
  tally_.push(rotated(X_WT.linear().transpose(), F_W));
}

void Contacts::forget() noexcept {
  touches_ = {};
}

}  // namespace repel::bullet::detail

// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/remote/remote_line.hpp>

namespace repel::network {

RemoteLine::RemoteLine(RemoteLink& link, const RemoteLineOptions& options)
    : link_(&link), options_(options) {
  checked("impedance", options.impedance, 1e-6, 1e6, "N s/m");
  checked("angular impedance", options.angular_impedance, 1e-6, 1e6, "N m s/rad");
}

void RemoteLine::fit(Space space, int size) {
  impedance_ = LineImpedance(space, size, options_.impedance, options_.angular_impedance);
  limiter_ = WaveLimiter(options_.bounds, impedance_, space);
  wave_.setZero(size);
}

void RemoteLine::prepare(double period) {
  period_ = detail::checked_period(period);
  limiter_.prepare(period_);
  link_->prepare(impedance_.size(), period_);
  link_->set_most_power(limiter_.most_power());
}

void RemoteLine::read(const Signals& signals) noexcept {
  limiter_.read(signals);
  link_->set_most_power(limiter_.most_power());
  wave_ = link_->play(signals.at_rest);
  is_cut_ = !options_.is_station && limiter_.cut(wave_);
  if (is_cut_) link_->count_cut();
}

void RemoteLine::equivalent(Equivalent<any_size>& shown) const noexcept {
  shown.form = Form::impedance;
  shown.matrix = impedance_.diagonal().asDiagonal();
  shown.offset = impedance_.offset_of(wave_);
}

void RemoteLine::incident(const PortState<any_size>& state) noexcept {
  limiter_.note(state);
  Vec<any_size> wave = impedance_.wave_of(state);
  limiter_.cut_to_sound(wave);
  link_->send(wave, period_);
}

}  // namespace repel::network

// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/wire/link_result.hpp>

#include <chrono>

#include <repel/host/figure.hpp>
#include <repel/link/link_thread.hpp>

namespace repel::runs {

void note_round_trips(const network::RemoteLink& link, LinkResult& result) noexcept {
  for (const std::chrono::nanoseconds each : link.round_trips()) result.round_trips.record(each);
}

void note_link(const network::RemoteLink& link, const link::LinkThread& thread,
               LinkResult& result) {
  result.name = thread.name();
  result.exposure = thread.exposure();
  result.is_sealed = thread.is_sealed();
  result.refused = thread.refused();
  result.counts = link.counts();
  result.foreign = thread.foreign();
  result.unsent = thread.unsent();
  result.buffer = link.player().buffer();
  result.silent = link.silent_for();
  result.energy_sent = link.energy_sent();
  result.energy_played = link.player().output();
  result.partner_sent = link.partner_sent();
  result.partner_played = link.partner_played();
}

void say_exposure(const link::LinkThread& thread) {
  if (thread.exposure().empty()) return;
  std::fprintf(stderr, "teleop: warning: %s (docs/two_machines.md)\n", thread.exposure().c_str());
}

void print_link(const LinkResult& r, std::FILE* out) {
  const network::RemoteCounts& c = r.counts;
  const auto count = [](std::int64_t n) { return static_cast<long long>(n); };
  std::fprintf(out, "  link                   %s", r.name.c_str());
  if (c.sessions == 0) {
    std::fprintf(out, "; the other side was NOT heard\n");
  } else {
    std::fprintf(out,
                 "; %lld sent, %lld received, %lld lost, %lld overtaken, longest silence %.0f ms\n",
                 count(c.sent), count(c.received), count(c.lost), count(c.overtaken),
                 1e3 * c.longest_silence);
    std::fprintf(out,
                 "  round trip             p50 %.1f ms, p99 %.1f ms, max %.1f ms as ticks see it; "
                 "buffer %.1f ms\n",
                 1e-3 * r.round_trips.percentile_us(0.5), 1e-3 * r.round_trips.percentile_us(0.99),
                 1e-3 * r.round_trips.max_us(), 1e3 * r.buffer);
    std::fprintf(
        out,
        "  energy over the link   sent %s J, played there %s J; heard of %s J, played here %s J\n",
        host::figure(r.energy_sent, 3).c_str(), host::figure(r.partner_played, 3).c_str(),
        host::figure(r.partner_sent, 3).c_str(), host::figure(r.energy_played, 3).c_str());
  }
  if (!r.is_sealed) {
    std::fprintf(out, "  key                    none: who reaches the link is heard\n");
  } else if (r.refused > 0) {
    std::fprintf(out,
                 "  key                    refused %lld packets: without it or with another one, "
                 "changed, or played again\n",
                 count(r.refused));
  }
  if (c.sessions > 1) {
    std::fprintf(out, "  the other side         began anew %lld times\n", count(c.sessions - 1));
  }
  if (c.beyond + c.cut + c.closed > 0) {
    std::fprintf(out,
                 "  beyond the bounds      %lld packets; cut to tool speed and force limit in %lld "
                 "ticks\n",
                 count(c.beyond), count(c.cut));
  }
  if (c.closed > 0) {
    std::fprintf(
        out,
        "  partners closed        %lld, for repeated packets out of bounds or malformed: a false "
        "station, or another version of this program\n",
        count(c.closed));
  }
  if (c.strangers + c.refused + r.foreign > 0) {
    std::fprintf(out,
                 "  not listened to        %lld packets of strangers or another scene, %lld not "
                 "sound, %lld no packets\n",
                 count(c.strangers), count(c.refused), count(r.foreign));
  }
}

nlohmann::ordered_json link_to_json(const LinkResult& r) {
  const network::RemoteCounts& c = r.counts;
  return {{"name", r.name},
          {"exposure", r.exposure},
          {"sealed", r.is_sealed},
          {"refused_packets", r.refused},
          {"packets_sent", c.sent},
          {"packets_received", c.received},
          {"packets_lost", c.lost},
          {"packets_overtaken", c.overtaken},
          {"packets_doubled", c.doubled},
          {"packets_refused", c.refused},
          {"packets_of_strangers", c.strangers},
          {"packets_beyond_bounds", c.beyond},
          {"ticks_cut_to_bounds", c.cut},
          {"partners_closed", c.closed},
          {"messages_foreign", r.foreign},
          {"packets_unsent", r.unsent},
          {"partner_sessions", c.sessions},
          {"longest_silence_s", c.longest_silence},
          {"silent_at_end_s", r.silent},
          {"buffer_s", r.buffer},
          {"round_trip_p50_us", r.round_trips.percentile_us(0.5)},
          {"round_trip_p99_us", r.round_trips.percentile_us(0.99)},
          {"round_trip_max_us", r.round_trips.max_us()},
          {"energy_sent_j", r.energy_sent},
          {"energy_played_j", r.energy_played},
          {"partner_energy_sent_j", r.partner_sent},
          {"partner_energy_played_j", r.partner_played}};
}

}  // namespace repel::runs

// SPDX-License-Identifier: BSD-3-Clause
#include <repel/host/trial/advice.hpp>

#include <sys/utsname.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>

namespace repel::host {
namespace {

namespace fs = std::filesystem;

std::string first_word_of(const fs::path& path) {
  std::ifstream file(path);
  std::string word;
  file >> word;
  return word;
}

bool is_preempt_rt() {
  utsname kernel{};
  uname(&kernel);
  return first_word_of("/sys/kernel/realtime") == "1" ||
         std::string(kernel.version).find("PREEMPT_RT") != std::string::npos;
}

std::vector<std::string> scaling_governors() {
  std::set<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/sys/devices/system/cpu", error)) {
    names.insert(first_word_of(entry.path() / "cpufreq/scaling_governor"));
  }
  names.erase("");
  return {names.begin(), names.end()};
}

bool is_virtual_machine() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("flags")) return line.find(" hypervisor") != std::string::npos;
  }
  return false;
}

/// For a user: raise the limit, effective from the next login. For root, a refusal means that the
/// container lacks the capability.
Advice raise(const Surroundings& s, const std::string& refused, const std::string& limit,
             const std::string& value, const std::string& container) {
  if (s.root) return {refused + " to root: this is a container without the right", container};
  return {refused + " (" + limit + " in /etc/security/limits.d; log in again afterwards)",
          "echo \"$USER - " + limit + " " + value +
              "\" | sudo tee -a /etc/security/limits.d/99-realtime.conf"};
}

void advise_on_permissions(const Surroundings& s, const Grant& grant, std::vector<Advice>& all) {
  if (grant.priority == 0) {
    all.push_back(raise(s, "SCHED_FIFO is refused", "rtprio", "99",
                        "docker run --cap-add SYS_NICE --ulimit rtprio=99 ..."));
  }
  if (!grant.memory_locked) {
    all.push_back(raise(s, "locking memory is refused", "memlock", "unlimited",
                        "docker run --cap-add IPC_LOCK --ulimit memlock=-1 ..."));
  }
  if (!grant.kept_awake && s.can_stay_awake) {
    all.push_back({"idle processors sleep, because /dev/cpu_dma_latency may not be written",
                   s.root ? "docker run --device /dev/cpu_dma_latency ..."
                          : "sudo setfacl -m u:$USER:rw /dev/cpu_dma_latency"});
  }
}

}  // namespace

Surroundings look_around() {
  return {is_preempt_rt(), scaling_governors(), is_virtual_machine(), geteuid() == 0,
          fs::exists("/dev/cpu_dma_latency")};
}

std::vector<Advice> advise(const Surroundings& s, const Trial& trial) {
  std::vector<Advice> all;
  if (!s.preempt_rt) {
    all.push_back({"the kernel is not PREEMPT_RT: it may hold up any thread",
                   "sudo apt-get install linux-image-rt-$(dpkg --print-architecture)"});
  }
  for (const std::string& governor : s.governors) {
    if (governor == "performance") continue;
    all.push_back({"the governor \"" + governor + "\" changes the frequency of processors",
                   "echo performance | sudo tee "
                   "/sys/devices/system/cpu/cpu*/cpufreq/scaling_governor"});
  }
  advise_on_permissions(s, trial.grant, all);
  if (s.virtual_machine || trial.stolen > 0.0) {
    char share[32];
    std::snprintf(share, sizeof share, "%.2f", 1e2 * trial.stolen);
    all.push_back({"this is a virtual machine, and " + std::string(share) +
                       " % of its time went to others: bind its processors on the host, or use "
                       "bare metal",
                   "virsh vcpupin DOMAIN VCPU PROCESSOR"});
  }
  return all;
}

}  // namespace repel::host

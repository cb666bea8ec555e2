// SPDX-License-Identifier: BSD-3-Clause
#include "packing.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#ifdef REPEL_RECORD_ZSTD
#include <zstd.h>
#endif

namespace repel::record::detail {

#ifdef REPEL_RECORD_ZSTD

namespace {

/// Messages are mostly numbers of 17 digits, of which short pieces recur by chance: to refer to
/// them takes more room than to write them. So only longer ones are looked for, but with care.
struct Setting {
  ZSTD_cParameter name;
  int value;
};
constexpr std::array settings{
    Setting{ZSTD_c_compressionLevel, 1}, Setting{ZSTD_c_strategy, ZSTD_lazy2},
    Setting{ZSTD_c_minMatch, 6},         Setting{ZSTD_c_hashLog, 17},
    Setting{ZSTD_c_chainLog, 17},        Setting{ZSTD_c_searchLog, 4},
};
/// [log2 bytes] of what a decoder keeps of what it has decoded. A file may ask for 2 GiB; 8 MiB is
/// what RFC 8878 wants every decoder to offer.
constexpr int most_window = 23;
constexpr std::size_t step = 131072;  ///< [bytes] the largest block of zstd

}  // namespace

std::string_view how_to_have_zstd() noexcept {
  return {};
}

struct Packer::State {
  struct Free {
    void operator()(ZSTD_CCtx* made) const noexcept { (void)ZSTD_freeCCtx(made); }
  };
  State() {
    if (!context) return;
    for (const Setting& each : settings) {
      (void)ZSTD_CCtx_setParameter(context.get(), each.name, each.value);
    }
  }
  std::unique_ptr<ZSTD_CCtx, Free> context{ZSTD_createCCtx()};
};

bool Packer::pack(std::string_view bytes, std::string& out) {
  if (!state_->context) return false;
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size = ZSTD_compress2(state_->context.get(), packed.data(), packed.size(),
                                          bytes.data(), bytes.size());
  if (ZSTD_isError(size) != 0) return false;
  packed.resize(size);
  out = std::move(packed);
  return true;
}

struct Unpacker::State {
  struct Free {
    void operator()(ZSTD_DCtx* made) const noexcept { (void)ZSTD_freeDCtx(made); }
  };
  State() {
    if (context) {
      (void)ZSTD_DCtx_setParameter(context.get(), ZSTD_d_windowLogMax, most_window);
    }
  }
  std::unique_ptr<ZSTD_DCtx, Free> context{ZSTD_createDCtx()};
};

Unpacker::Outcome Unpacker::unpack(std::string_view packed, std::uint64_t size, std::string& out) {
  out.clear();
  ZSTD_DCtx* const context = state_->context.get();
  if (context == nullptr) return Outcome::damaged;
  (void)ZSTD_DCtx_reset(context, ZSTD_reset_session_only);
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  std::size_t wanted = 1;  // 0: a frame is complete; another may follow
  while (wanted != 0 || in.pos < in.size) {
    const std::size_t before = out.size();
    const std::size_t room = std::min<std::uint64_t>(step, size - before);
    out.resize(before + room);
    ZSTD_outBuffer to{out.data(), out.size(), before};
    const std::size_t at = in.pos;
    wanted = ZSTD_decompressStream(context, &to, &in);
    out.resize(to.pos);
    if (ZSTD_isError(wanted) != 0) return Outcome::damaged;
    const bool stands = to.pos == before && in.pos == at;
    if (wanted != 0 && stands) return in.pos < in.size ? Outcome::damaged : Outcome::cut;
  }
  return out.size() == size ? Outcome::whole : Outcome::damaged;
}

#else

std::string_view how_to_have_zstd() noexcept {
  return "apt-get install libzstd-dev, then build again";
}

struct Packer::State {};

bool Packer::pack(std::string_view /*bytes*/, std::string& /*out*/) {
  return false;
}

struct Unpacker::State {};

Unpacker::Outcome Unpacker::unpack(std::string_view /*packed*/, std::uint64_t /*size*/,
                                   std::string& out) {
  out.clear();
  return Outcome::damaged;
}

#endif

Packer::Packer() : state_(std::make_unique<State>()) {}
Packer::~Packer() = default;
Unpacker::Unpacker() : state_(std::make_unique<State>()) {}
Unpacker::~Unpacker() = default;

}  // namespace repel::record::detail

// SPDX-License-Identifier: BSD-3-Clause
#include "gzip.hpp"

#include <charconv>
#include <cstdint>

#include <boost/beast/core/error.hpp>
#include <boost/beast/core/string.hpp>
#include <boost/beast/http/rfc7230.hpp>
#include <boost/beast/zlib/deflate_stream.hpp>
#include <boost/crc.hpp>

namespace repel::visual {
namespace {

namespace beast = boost::beast;

/// Least significant byte first.
void append_word(std::string& out, std::uint32_t word) {
  for (int k = 0; k < 4; ++k) out.push_back(static_cast<char>((word >> (8 * k)) & 0xFFU));
}

std::string deflated(std::string_view text) {
  namespace zlib = beast::zlib;
  zlib::deflate_stream stream;
  stream.reset(9, 15, 8, zlib::Strategy::normal);
  // Beyond what zlib promises, for the empty text as well.
  std::string out(stream.upper_bound(text.size()) + 64, '\0');
  zlib::z_params z;
  z.next_in = text.data();
  z.avail_in = text.size();
  z.next_out = out.data();
  z.avail_out = out.size();
  beast::error_code error;
  stream.write(z, zlib::Flush::finish, error);
  out.resize(z.total_out);
  return out;
}

/// A weight of 0, in any spelling, refuses a coding.
bool is_zero(std::string_view weight) {
  double value = 1.0;
  std::from_chars(weight.data(), weight.data() + weight.size(), value);
  return !(value > 0.0);
}

}  // namespace

std::string gzipped(std::string_view text) {
  // Magic number, deflate, no flags, no time, best compression, unknown system.
  std::string out("\x1f\x8b\x08\x00\x00\x00\x00\x00\x02\xff", 10);
  out += deflated(text);
  boost::crc_32_type sum;
  sum.process_bytes(text.data(), text.size());
  append_word(out, sum.checksum());
  append_word(out, static_cast<std::uint32_t>(text.size()));
  return out;
}

bool accepts_gzip(std::string_view header) {
  for (const auto& [name, parameters] :
       beast::http::ext_list(beast::string_view(header.data(), header.size()))) {
    if (!beast::iequals(name, "gzip")) continue;
    for (const auto& [key, value] : parameters) {
      if (beast::iequals(key, "q") && is_zero({value.data(), value.size()})) return false;
    }
    return true;
  }
  return false;
}

}  // namespace repel::visual

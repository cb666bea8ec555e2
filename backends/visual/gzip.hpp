// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Compression of the files of the page, as browsers accept it.
#pragma once

#include <string>
#include <string_view>

namespace repel::visual {

/// `text` as a gzip file of one member without a name or time (RFC 1952): the same text always
/// gives the same bytes. Some 50 ms per MB; for set-up.
[[nodiscard]] std::string gzipped(std::string_view text);

/// Whether a header Accept-Encoding (RFC 9110, 12.5.3) names gzip, and not with a weight of 0.
[[nodiscard]] bool accepts_gzip(std::string_view header);

}  // namespace repel::visual

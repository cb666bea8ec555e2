// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Certificates with which the live view is served over TLS.
#pragma once

#include <string>

namespace repel::visual {

/// A certificate and its private key, as PEM files; both may be one file.
struct TlsFiles {
  std::string certificate;  ///< path; with the chain behind it, if there is one
  std::string key;          ///< path; without a passphrase
};

/// A certificate that this machine signs itself, in `folder`: made by the first call, with a key
/// that only its owner can read, for ten years.
/// @throws SetupError if it cannot be written there
[[nodiscard]] TlsFiles own_certificate(const std::string& folder);

/// The SHA-256 fingerprint of a certificate as browsers show it, "0A:1B:...", to compare.
/// @throws SetupError if the file has no certificate
[[nodiscard]] std::string fingerprint_of(const TlsFiles& files);

}  // namespace repel::visual

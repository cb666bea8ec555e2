// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How the server speaks TLS.
#pragma once

#include <boost/asio/ssl/context.hpp>

#include <repel/visual/tls.hpp>

namespace repel::visual {

/// TLS 1.2 or newer with this certificate.
/// @throws SetupError if a file cannot be read, the key does not fit the certificate, or that has
///   expired or does not count yet
[[nodiscard]] boost::asio::ssl::context tls_context(const TlsFiles& files);

}  // namespace repel::visual

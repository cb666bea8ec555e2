// SPDX-License-Identifier: BSD-3-Clause
#include "tls_context.hpp"

#include <memory>
#include <string>

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>

#include <repel/base/setup_error.hpp>

namespace repel::visual {
namespace {

namespace ssl = boost::asio::ssl;

std::string text_of(const ASN1_TIME* time) {
  const std::unique_ptr<BIO, decltype(&BIO_free)> text(BIO_new(BIO_s_mem()), &BIO_free);
  ASN1_TIME_print(text.get(), time);
  char* begin = nullptr;
  const long size = BIO_get_mem_data(text.get(), &begin);
  return {begin, static_cast<std::size_t>(size)};
}

void require_that_it_counts(const X509* certificate, const std::string& file) {
  const ASN1_TIME* const begin = X509_get0_notBefore(certificate);
  const ASN1_TIME* const end = X509_get0_notAfter(certificate);
  std::string wrong;
  if (X509_cmp_current_time(begin) > 0) wrong = "does not count before " + text_of(begin);
  if (X509_cmp_current_time(end) < 0) wrong = "has expired on " + text_of(end);
  if (wrong.empty()) return;
  throw SetupError("the certificate " + wrong + "; allowed: one that counts now", file);
}

}  // namespace

ssl::context tls_context(const TlsFiles& files) {
  ssl::context context(ssl::context::tls_server);
  SSL_CTX* const ctx = context.native_handle();
  SSL_CTX_set_min_proto_version(ctx, TLS1_2_VERSION);
  SSL_CTX_set_options(ctx, SSL_OP_NO_RENEGOTIATION);
  // Otherwise OpenSSL would ask for the passphrase of a key on the terminal.
  context.set_password_callback([](std::size_t, ssl::context::password_purpose) { return ""; });
  boost::system::error_code error;
  (void)context.use_certificate_chain_file(files.certificate, error);
  if (error) {
    throw SetupError("has no certificate in PEM that can be read: " + error.message(),
                     files.certificate);
  }
  require_that_it_counts(SSL_CTX_get0_certificate(ctx), files.certificate);
  (void)context.use_private_key_file(files.key, ssl::context::pem, error);
  if (ERR_GET_REASON(static_cast<unsigned long>(error.value())) == X509_R_KEY_VALUES_MISMATCH) {
    throw SetupError("the key does not fit the certificate '" + files.certificate + "'", files.key);
  }
  if (error) {
    throw SetupError(
        "has no private key that can be read, in PEM and without a passphrase: " + error.message(),
        files.key);
  }
  return context;
}

}  // namespace repel::visual

// SPDX-License-Identifier: BSD-3-Clause
#include <repel/visual/tls.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>

#include <repel/base/setup_error.hpp>

namespace repel::visual {
namespace {

struct End {
  void operator()(X509* ended) const { X509_free(ended); }
  void operator()(EVP_PKEY* ended) const { EVP_PKEY_free(ended); }
  void operator()(X509_EXTENSION* ended) const { X509_EXTENSION_free(ended); }
  void operator()(std::FILE* ended) const { (void)std::fclose(ended); }
};
template <class T>
using Owned = std::unique_ptr<T, End>;

constexpr long ten_years = 10L * 365 * 24 * 3600;  // [s]

/// Signed by its own key, for `localhost` and whoever accepts its fingerprint; null: out of memory.
Owned<X509> signed_by(EVP_PKEY* key) {
  Owned<X509> made(X509_new());
  X509* const x = made.get();
  X509_NAME* const name = x == nullptr ? nullptr : X509_get_subject_name(x);
  const auto* const text = reinterpret_cast<const unsigned char*>("repel live view");
  if (name == nullptr || X509_set_version(x, X509_VERSION_3) != 1 ||
      ASN1_INTEGER_set(X509_get_serialNumber(x), 1) != 1 ||
      X509_gmtime_adj(X509_getm_notBefore(x), 0) == nullptr ||
      X509_gmtime_adj(X509_getm_notAfter(x), ten_years) == nullptr ||
      X509_set_pubkey(x, key) != 1 ||
      X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC, text, -1, -1, 0) != 1 ||
      X509_set_issuer_name(x, name) != 1) {
    return nullptr;
  }
  const Owned<X509_EXTENSION> names(X509V3_EXT_conf_nid(
      nullptr, nullptr, NID_subject_alt_name, "DNS:localhost,IP:127.0.0.1,IP:0:0:0:0:0:0:0:1"));
  const bool whole = names && X509_add_ext(x, names.get(), -1) == 1;
  return whole && X509_sign(x, key, EVP_sha256()) != 0 ? std::move(made) : nullptr;
}

/// In one step: who starts at the same time finds a whole file.
bool write_whole(const std::string& path, EVP_PKEY* key, X509* certificate) {
  const std::string draft = path + "." + std::to_string(::getpid());
  const int file = ::open(draft.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (file < 0) return false;
  const Owned<std::FILE> out(::fdopen(file, "w"));
  const bool written =
      out && PEM_write_PrivateKey(out.get(), key, nullptr, nullptr, 0, nullptr, nullptr) == 1 &&
      PEM_write_X509(out.get(), certificate) == 1 && std::fflush(out.get()) == 0;
  return written && std::rename(draft.c_str(), path.c_str()) == 0;
}

Owned<X509> certificate_in(const std::string& path) {
  const Owned<std::FILE> file(std::fopen(path.c_str(), "r"));
  Owned<X509> found(file ? PEM_read_X509(file.get(), nullptr, nullptr, nullptr) : nullptr);
  ERR_clear_error();
  if (!found) throw SetupError("has no certificate in PEM that can be read", path);
  return found;
}

}  // namespace

TlsFiles own_certificate(const std::string& folder) {
  const std::string path = folder + "/page.pem";
  std::error_code error;
  if (std::filesystem::exists(path, error)) return {path, path};
  std::filesystem::create_directories(folder, error);
  const Owned<EVP_PKEY> key(EVP_EC_gen("P-256"));
  const Owned<X509> certificate = key ? signed_by(key.get()) : nullptr;
  if (!certificate || !write_whole(path, key.get(), certificate.get())) {
    throw SetupError("a certificate for the live view cannot be written there", path);
  }
  return {path, path};
}

std::string fingerprint_of(const TlsFiles& files) {
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int size = 0;
  X509_digest(certificate_in(files.certificate).get(), EVP_sha256(), digest, &size);
  std::string text;
  for (unsigned int i = 0; i < size; ++i) {
    char digits[4];
    (void)std::snprintf(digits, sizeof digits, "%02X", digest[i]);
    text.append(i == 0 ? "" : ":").append(digits);
  }
  return text;
}

}  // namespace repel::visual

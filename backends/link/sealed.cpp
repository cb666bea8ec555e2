// SPDX-License-Identifier: BSD-3-Clause
#include <repel/sealed/sealed.hpp>

#include <sodium.h>

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <utility>

#include <repel/base/setup_error.hpp>
#include <repel/network/remote/wave_player.hpp>

namespace repel::sealed {
namespace {

using link::Origin;
using link::sealed_size;
using link::Side;
using std::chrono::steady_clock;

/// The head of every datagram, then a packet or zeros, then a tag over all of it.
constexpr std::size_t numbers_at = 8, count_at = 40, body_at = 48;
constexpr std::size_t tag_at = body_at + link::wire_size;
static_assert(sealed_size == tag_at + crypto_aead_chacha20poly1305_ietf_ABYTES);

/// What a datagram is: by its sixth byte.
enum class Kind : std::uint8_t {
  hello = 1,   ///< of a station: its number
  answer = 2,  ///< of a site: the number of that station and its own
  packet = 3,  ///< in the session of both numbers
};

using Bytes = std::array<unsigned char, sealed_size + 1>;  // one more, to see what is too long
using Number = std::array<unsigned char, 16>;              // random, fresh
using Subkey = std::array<unsigned char, 32>;
static_assert(sizeof(Subkey) == crypto_aead_chacha20poly1305_ietf_KEYBYTES);
static_assert(sizeof(Key) == crypto_kdf_KEYBYTES && sizeof(Subkey) >= crypto_generichash_KEYBYTES);

/// What names a session: the fresh numbers of both sides.
struct Numbers {
  Number station{}, site{};
  friend bool operator==(const Numbers&, const Numbers&) = default;
};

static_assert(sizeof(Numbers) == 2 * sizeof(Number));

/// Of a session, one for each direction.
struct SessionKeys {
  Subkey to_site{}, to_station{};
};
static_assert(sizeof(SessionKeys) == crypto_generichash_BYTES_MAX);

Subkey derived(const Key& key, std::uint64_t which) {
  Subkey subkey;
  crypto_kdf_derive_from_key(subkey.data(), subkey.size(), which, "repelink", key.data());
  return subkey;
}

Number drawn() noexcept {
  Number number;
  randombytes_buf(number.data(), number.size());
  return number;
}

/// One partner since both sides have drawn their numbers.
struct Session {
  static constexpr std::size_t window = 1024;  ///< places by which packets may be overtaken

  Numbers numbers;
  SessionKeys keys;
  Origin origin;              ///< of its newest packet
  std::uint64_t speaker = 0;  ///< RemotePacket::session in that
  steady_clock::time_point heard{};
  std::uint64_t newest = 0;
  std::array<std::uint64_t, window> taken{};  ///< the last count taken of those of the same place

  /// False for a count that was there already, or may have been.
  [[nodiscard]] bool takes(std::uint64_t count) noexcept {
    std::uint64_t& last = taken[count % window];
    if (count <= last || count + window <= newest) return false;
    last = count;
    newest = std::max(newest, count);
    return true;
  }
  [[nodiscard]] bool is_silent(steady_clock::time_point now) const noexcept {
    return now - heard > std::chrono::duration<double>(network::WavePlayer::silence);
  }
};

class SealedTransport final : public link::Transport {
 public:
  SealedTransport(std::unique_ptr<link::Datagrams> datagrams, Side side, const Key& key)
      : datagrams_(std::move(datagrams)),
        side_(side),
        hello_key_(derived(key, 1)),
        session_key_(derived(key, 2)),
        own_(drawn()) {}
  SealedTransport(const SealedTransport&) = delete;
  SealedTransport& operator=(const SealedTransport&) = delete;
  ~SealedTransport() override {
    sodium_memzero(hello_key_.data(), hello_key_.size());
    sodium_memzero(session_key_.data(), session_key_.size());
    for (Session& session : sessions_) sodium_memzero(&session.keys, sizeof session.keys);
  }

  bool send(const network::RemotePacket& packet) noexcept override {
    const Session* session = is_site() ? spoken_to(packet.heard) : current_;
    if (session == nullptr) return false;
    Bytes out{};
    begin(out, Kind::packet, session->numbers);
    ++sent_;
    for (std::size_t i = 0; i < 8; ++i) {
      out[count_at + i] = static_cast<unsigned char>(sent_ >> (8 * i));
    }
    link::WireBytes plain;
    link::encode(packet, plain);
    crypto_aead_chacha20poly1305_ietf_encrypt(
        out.data() + body_at, nullptr, reinterpret_cast<const unsigned char*>(plain.data()),
        plain.size(), out.data(), body_at, nullptr, nonce_of(out).data(),
        (is_site() ? session->keys.to_station : session->keys.to_site).data());
    return pass_on(out, session->origin);
  }

  bool receive(network::RemotePacket& packet) noexcept override {
    if (!is_site()) ask();
    // A bound for a flood of what is refused.
    for (int tries = 0; tries < 64; ++tries) {
      Bytes in{};
      Origin from;
      const std::ptrdiff_t size = datagrams_->receive(std::as_writable_bytes(std::span(in)), from);
      if (size < 0) return false;
      const bool is_whole = size == sealed_size && std::memcmp(in.data(), "repel", 5) == 0 &&
                            in[6] == 0 && in[7] == version;
      const auto kind = static_cast<Kind>(in[5]);
      if (is_whole && kind == Kind::packet && opens(in, from, packet)) return true;
      if (is_whole && kind == Kind::hello && is_site() && answers(in, from)) continue;
      if (is_whole && kind == Kind::answer && !is_site() && takes_answer(in, from)) continue;
      ++refused_;
    }
    return false;
  }

  void wait(std::chrono::microseconds longest) noexcept override { datagrams_->wait(longest); }
  [[nodiscard]] std::string name() const override { return datagrams_->name() + ", sealed"; }
  [[nodiscard]] bool is_sealed() const noexcept override { return true; }
  [[nodiscard]] std::int64_t refused() const noexcept override { return refused_; }

 private:
  static constexpr unsigned char version = 1;
  /// A station says hello so often while there is no answer, and waits so long for the first packet
  /// after one.
  static constexpr std::chrono::milliseconds hello_period{50}, answer_patience{1000};

  [[nodiscard]] bool is_site() const noexcept { return side_ == Side::site; }

  static void begin(Bytes& out, Kind kind, const Numbers& numbers) noexcept {
    std::memcpy(out.data(), "repel", 5);
    out[5] = static_cast<unsigned char>(kind);
    out[7] = version;
    std::memcpy(out.data() + numbers_at, &numbers, sizeof numbers);
  }
  [[nodiscard]] static Numbers numbers_of(const Bytes& in) noexcept {
    Numbers numbers;
    std::memcpy(&numbers, in.data() + numbers_at, sizeof numbers);
    return numbers;
  }
  /// Nonce of the encryption: the count in the head, unique under a key.
  [[nodiscard]] static std::array<unsigned char, 12> nonce_of(const Bytes& bytes) noexcept {
    std::array<unsigned char, 12> nonce{};
    static_assert(sizeof nonce == crypto_aead_chacha20poly1305_ietf_NPUBBYTES);
    std::memcpy(nonce.data() + 4, bytes.data() + count_at, 8);
    return nonce;
  }
  bool pass_on(const Bytes& out, const Origin& to) noexcept {
    return datagrams_->send(std::as_bytes(std::span(out)).first<sealed_size>(), to);
  }

  /// The tag of what is no packet.
  [[nodiscard]] std::array<unsigned char, 16> tag_of(const Bytes& bytes) const noexcept {
    std::array<unsigned char, 16> tag;
    crypto_generichash(tag.data(), tag.size(), bytes.data(), tag_at, hello_key_.data(),
                       hello_key_.size());
    return tag;
  }
  [[nodiscard]] bool has_tag(const Bytes& in) const noexcept {
    return crypto_verify_16(tag_of(in).data(), in.data() + tag_at) == 0;
  }
  bool send_tagged(Kind kind, const Numbers& numbers, const Origin& to) noexcept {
    Bytes out{};
    begin(out, kind, numbers);
    const auto tag = tag_of(out);
    std::memcpy(out.data() + tag_at, tag.data(), tag.size());
    return pass_on(out, to);
  }

  /// Of a station that hears nothing: says hello, with one number until it is answered.
  void ask() noexcept {
    const auto now = steady_clock::now();
    if (now < ask_at_ || (current_ != nullptr && !current_->is_silent(now))) return;
    if (!asks_) asked_ = drawn();
    asks_ = true;
    (void)send_tagged(Kind::hello, {asked_, {}}, {});
    ask_at_ = now + hello_period;
  }
  /// Nothing is kept: what comes in the session proves the key.
  bool answers(const Bytes& in, const Origin& from) noexcept {
    if (!has_tag(in)) return false;
    (void)send_tagged(Kind::answer, {numbers_of(in).station, own_}, from);
    return true;
  }
  /// Begins the session that this names. True as well for one that comes late or once more.
  bool takes_answer(const Bytes& in, const Origin& from) noexcept {
    if (!has_tag(in)) return false;
    const Numbers numbers = numbers_of(in);
    if (numbers.station != asked_) return false;
    if (!asks_) return true;
    Session* const session = free_place();
    if (session == nullptr) return true;
    start(*session, numbers, keys_of(numbers), from);
    current_ = session;
    asks_ = false;
    ask_at_ = session->heard + answer_patience;
    return true;
  }

  /// Opens a packet of a session; at a site, the first one begins it.
  bool opens(const Bytes& in, const Origin& from, network::RemotePacket& packet) noexcept {
    const Numbers numbers = numbers_of(in);
    Session* session = find(numbers);
    const bool begins = session == nullptr;
    if (begins && (!is_site() || numbers.site != own_)) return false;
    const SessionKeys keys = begins ? keys_of(numbers) : session->keys;
    link::WireBytes plain;
    if (crypto_aead_chacha20poly1305_ietf_decrypt(
            reinterpret_cast<unsigned char*>(plain.data()), nullptr, nullptr, in.data() + body_at,
            sealed_size - body_at, in.data(), body_at, nonce_of(in).data(),
            (is_site() ? keys.to_site : keys.to_station).data()) != 0) {
      return false;
    }
    if (!link::decode(plain, packet)) return false;
    if (begins) {
      session = free_place();
      if (session == nullptr) return false;
      start(*session, numbers, keys, from);
      own_ = drawn();  // so that this session cannot begin again
    }
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < 8; ++i) {
      count |= static_cast<std::uint64_t>(in[count_at + i]) << (8 * i);
    }
    if (!session->takes(count)) return false;
    session->heard = steady_clock::now();
    if (count == session->newest) {
      session->origin = from;
      session->speaker = packet.session;
    }
    if (session == current_) asks_ = false;
    return true;
  }

  [[nodiscard]] SessionKeys keys_of(const Numbers& numbers) const noexcept {
    std::array<unsigned char, sizeof(SessionKeys)> both;
    const auto named = std::bit_cast<std::array<unsigned char, sizeof numbers>>(numbers);
    crypto_generichash(both.data(), both.size(), named.data(), named.size(), session_key_.data(),
                       session_key_.size());
    return std::bit_cast<SessionKeys>(both);
  }
  [[nodiscard]] Session* find(const Numbers& numbers) noexcept {
    const auto found =
        std::find_if(sessions_.begin(), sessions_.end(), [&](const Session& session) {
          return session.heard != steady_clock::time_point{} && session.numbers == numbers;
        });
    return found == sessions_.end() ? nullptr : &*found;
  }
  /// That of the partner silent for longest; null while all are heard.
  [[nodiscard]] Session* free_place() noexcept {
    auto* const place =
        std::min_element(sessions_.begin(), sessions_.end(),
                         [](const Session& a, const Session& b) { return a.heard < b.heard; });
    return place->is_silent(steady_clock::now()) ? place : nullptr;
  }
  static void start(Session& session, const Numbers& numbers, const SessionKeys& keys,
                    const Origin& from) noexcept {
    session = Session{};
    session.numbers = numbers;
    session.keys = keys;
    session.origin = from;
    session.heard = steady_clock::now();
  }
  /// Where the program with this session was heard last.
  [[nodiscard]] const Session* spoken_to(std::uint64_t heard) const noexcept {
    const Session* found = nullptr;
    for (const Session& session : sessions_) {
      if (heard == 0 || session.speaker != heard) continue;
      if (found == nullptr || session.heard > found->heard) found = &session;
    }
    return found;
  }

  std::unique_ptr<link::Datagrams> datagrams_;
  Side side_;
  Subkey hello_key_, session_key_;
  std::array<Session, 8> sessions_{};
  std::uint64_t sent_ = 0;  // in all sessions, so that no count is used again
  std::int64_t refused_ = 0;
  Number own_;                        // of a site, until a session begins with it
  Number asked_{};                    // of a station, with its last hello
  bool asks_ = false;                 // and is not answered yet
  const Session* current_ = nullptr;  // of a station: in which it sends
  steady_clock::time_point ask_at_{};
};

}  // namespace

std::unique_ptr<link::Transport> seal(std::unique_ptr<link::Datagrams> datagrams, link::Side side,
                                      const Key& key) {
  if (sodium_init() < 0) throw SetupError("libsodium finds no random numbers");
  return std::make_unique<SealedTransport>(std::move(datagrams), side, key);
}

}  // namespace repel::sealed

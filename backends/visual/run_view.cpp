// SPDX-License-Identifier: BSD-3-Clause
#include <boost/asio/ip/address.hpp>

#include <repel/base/setup_error.hpp>
#include <repel/visual/run_view.hpp>

#include "live_pages.hpp"

namespace repel::visual {
namespace {

constexpr std::size_t least_secret = 16;

bool is_loopback(const std::string& text) {
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(text, error);
  return !error && address.is_loopback();
}

/// What the server may be started with.
const ServerOptions& guarded(const ServerOptions& options) {
  const std::size_t length = options.secret.size();
  if (length >= least_secret || (length == 0 && is_loopback(options.address))) return options;
  throw SetupError(
      "the live view at " + options.address + " has a secret of " + std::to_string(length) +
      " characters; allowed: " + std::to_string(least_secret) + " or more, or none at 127.0.0.1");
}

}  // namespace

class RunView::Impl {
 public:
  Impl(const SceneInfo& info, const World& world, Tap& tap, Controls& controls,
       const ViewOptions& options)
      : pages_(info, world, tap, controls, options.master, options.pages_drive),
        server_(guarded(options.server),
                load_assets(options.page.empty() ? page_folder() : options.page), pages_) {}

  [[nodiscard]] const std::string& url() const noexcept { return server_.url(); }

 private:
  LivePages pages_;
  Server server_;
};

RunView::RunView(const SceneInfo& info, const World& world, Tap& tap, Controls& controls,
                 const ViewOptions& options)
    : impl_(std::make_unique<Impl>(info, world, tap, controls, options)) {}
RunView::~RunView() = default;

const std::string& RunView::url() const noexcept {
  return impl_->url();
}

}  // namespace repel::visual

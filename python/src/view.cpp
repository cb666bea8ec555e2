// SPDX-License-Identifier: BSD-3-Clause
#include <repel/visual/live_view.hpp>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <repel/base/setup_error.hpp>

#include "bindings.hpp"
#include "own_cell.hpp"

namespace repel::python {
namespace {

/// The live view of a cell that a program in Python ticks.
class OwnView : public ShapeListener {
 public:
  OwnView(OwnCell& cell, const std::string& name, const visual::ViewOptions& options)
      : cell_(&cell) {
    const InUse in_use = cell.use();
    view_ = std::make_unique<visual::LiveView>(cell.cell(),
                                               visual::scene_info_of(cell.cell(), name), options);
    cell.listeners.push_back(this);
  }
  OwnView(const OwnView&) = delete;
  OwnView& operator=(const OwnView&) = delete;
  ~OwnView() { close(); }

  [[nodiscard]] std::optional<network::Command> command() {
    const InUse in_use = cell_->use();
    const network::Command* const page = open().command();
    return page == nullptr ? std::nullopt : std::optional(*page);
  }

  void publish(double late, double compute) {
    const InUse in_use = cell_->use();
    if (cell_->records().empty()) throw SetupError("publish comes after a tick of the cell");
    const auto time = [](const char* name, double seconds) {
      return std::chrono::nanoseconds(
          static_cast<std::int64_t>(1e9 * checked(name, seconds, 0.0, 1e6, "s")));
    };
    open().show(cell_->records(),
                {.late = time("late", late), .compute = time("compute", compute)});
  }

  [[nodiscard]] const std::string& url() { return open().url(); }

  void close() {
    std::erase(cell_->listeners, this);
    view_.reset();
  }

  [[nodiscard]] OwnCell* cell() const noexcept { return cell_; }

 private:
  void shaped(PartId part, const Shape& shape) override { view_->reshape(part, shape); }

  [[nodiscard]] visual::LiveView& open() {
    if (view_ == nullptr) throw SetupError("the live view is closed");
    return *view_;
  }

  OwnCell* cell_;
  std::unique_ptr<visual::LiveView> view_;
};

visual::ViewOptions options_of(const std::string& address, int port, bool pages_drive,
                               const std::string& secret) {
  visual::ViewOptions options{.pages_drive = pages_drive};
  // The page is in the package, not beside the interpreter.
  options.page = nb::cast<std::string>(nb::module_::import_("repel._scenes").attr("PAGE"));
  options.server.address = address;
  options.server.port = static_cast<std::uint16_t>(checked("port", port, 0.0, 65535.0, ""));
  options.server.secret = secret;
  return options;
}

}  // namespace

void bind_views(nb::module_& m) {
  nb::class_<OwnView>(m, "LiveView", nb::type_slots(companion_slots<OwnView>),
                      "The page of the live view for a Cell that your program ticks. A context "
                      "manager: at its end the page is no longer served.")
      .def(
          "__init__",
          [](OwnView* self, OwnCell& cell, const std::string& name, const std::string& address,
             int port, bool pages_drive, const std::string& secret) {
            new (self) OwnView(cell, name, options_of(address, port, pages_drive, secret));
          },
          nb::keep_alive<1, 2>(), nb::arg("cell"), nb::arg("name") = "cell", nb::kw_only(),
          nb::arg("address") = visual::ServerOptions{}.address,
          nb::arg("port") = visual::ServerOptions{}.port, nb::arg("pages_drive") = false,
          nb::arg("secret") = "",
          "Serves the page at `address` and `port`, 0: any that is free, in a thread of its own. "
          "pages_drive: one page at a time may drive the first arm. secret, of 16 characters or "
          "more: needed where other machines reach the address. Raises SetupError if it cannot be "
          "served.")
      .def("command", &OwnView::command,
           "Before `step`, or between `sense` and `act`: the Command of the page that drives the "
           "first arm; None: none does.")
      .def("publish", &OwnView::publish, nb::arg("late") = 0.0, nb::arg("compute") = 0.0,
           "After a tick: shows it. late [s] after it was due, compute [s] that it took, for the "
           "histograms of the page.")
      .def("close", &OwnView::close)
      .def_prop_ro("url", &OwnView::url, "Of the page, for a browser on this machine.")
      .def(
          "__enter__", [](nb::handle self) { return nb::borrow(self); },
          nb::sig("def __enter__(self) -> LiveView"))
      .def(
          "__exit__", [](OwnView& view, const nb::args&) { view.close(); },
          nb::sig("def __exit__(self, *args: object) -> None"));
}

}  // namespace repel::python

// SPDX-License-Identifier: BSD-3-Clause
#include "options.hpp"

#include <map>
#include <string>
#include <vector>

#include <repel/runs/arms/arm_backend.hpp>
#include <repel/runs/faults/choice.hpp>
#include <repel/runs/operator/device.hpp>
#include <repel/runs/options/link_choice.hpp>
#include <repel/runs/options/listening.hpp>

#include "scenes.hpp"

namespace repel::teleop {
namespace {

struct CommandEntry {
  Command command;
  const char* name;
  const char* about;
};
constexpr CommandEntry commands[] = {
    {Command::run, "run", "Run a scene: an operator drives a simulated arm"},
    {Command::replay, "replay", "Go through a recording again, and compare the forces"},
    {Command::site, "site", "Run the robot's side of a scene, until it is stopped"},
    {Command::station, "station", "Run the operator's side of a scene, up to its line"},
    {Command::key, "key", "Make a key for the link between both sides of a scene"},
    {Command::check, "check", "Read a scene and build its cell: is it sound, or what is wrong?"},
    {Command::list, "list", "List the scenes that come with the program"}};

/// What is run, and how.
void describe_run(CLI::App& app, Command command, Arguments& a) {
  app.option_defaults()->group("Run");
  if (command == Command::replay) {
    app.add_option("file", a.recording, "Recording, as run --log FILE.mcap writes it")
        ->required()
        ->type_name("FILE");
    return;
  }
  app.add_option("scene", a.scene, "Scene file, or the name of one that comes with the program")
      ->capture_default_str();
  if (command == Command::check) {
    app.add_flag("--schema", a.schema, "Print the JSON Schema of scene files, for editors");
  }
  static const std::map<Command, runs::Choosing> choosing{
      {Command::check, runs::Choosing::check},
      {Command::station, runs::Choosing::station},
      {Command::site, runs::Choosing::site},
      {Command::run, runs::Choosing::run}};
  runs::describe(app, choosing.at(command), a.choice);
}

/// The live view, and a master in its place.
void describe_view(CLI::App& app, Command command, Arguments& a) {
  app.option_defaults()->group("View");
  CLI::Option* view = app.add_flag("--view", a.session.view,
                                   "Serve the live view: a page to look on and to drive from");
  app.add_option("--listen", a.session.listen, "ADDRESS:PORT of the live view; port 0: any")
      ->capture_default_str()
      ->needs(view)
      ->check(CLI::Validator(runs::listen_complaint, "ADDRESS:PORT"));
  CLI::Option* open =
      app.add_flag_callback(
             "--open", [&a] { a.session.open = true; },
             "Open the view in the browser of this desktop (default: if started at its terminal)")
          ->needs(view);
  app.add_flag_callback(
         "--no-open", [&a] { a.session.open = false; }, "Leave it to you to open the view")
      ->needs(view)
      ->excludes(open);
  CLI::Option* file =
      app.add_option("--secret", a.session.secret_file,
                     "Secret of the pages, #secret=... behind the address: the first line of FILE, "
                     "16 characters or more. Required if other machines reach the view")
          ->needs(view)
          ->type_name("FILE");
  app.add_option("--secret-env", a.session.secret_env,
                 "The same from the environment variable NAME")
      ->needs(view)
      ->excludes(file)
      ->type_name("NAME");
  CLI::Option* tls =
      app.add_option("--tls", a.session.tls,
                     "Serve the view over TLS: self (a certificate made at the first start) or "
                     "CERTIFICATE,KEY (PEM files). Required if other machines reach the view")
          ->needs(view)
          ->check(CLI::Validator(runs::tls_complaint, "self or CERTIFICATE,KEY"));
  app.add_flag(
         "--plain", a.session.plain,
         "Without TLS, though others reach the view: whoever is on the way can read and drive")
      ->needs(view)
      ->excludes(tls);
  CLI::Option* only = app.add_flag("--view-only", a.session.view_only,
                                   "Pages look on: they do not drive, pause, step or restart")
                          ->needs(view);
  if (command != Command::run && command != Command::station) return;
  CLI::Option* device =
      app.add_option("--device", a.session.device,
                     "Master driving in place of the script: spacenav (a six-axis mouse, through "
                     "spacenavd), evdev:PATH (a motorised lever) or haply[:URL] (an Inverse3, "
                     "through its service). Runs until stopped, unless --seconds is given");
  device->check(CLI::Validator(runs::device_complaint, "spacenav, evdev:PATH or haply[:URL]"));
  app.add_flag("--page-drives", a.session.page_drives,
               "With --device: pages may take the controls from it; otherwise they look on")
      ->needs(view)
      ->needs(device)
      ->excludes(only);
}

/// The two sides of a scene, and what joins them.
void describe_link(CLI::App& app, Command command, Arguments& a) {
  app.option_defaults()->group("Link");
  if (command == Command::run) {
    app.add_option("--programs", a.programs,
                   "two: run both sides as two programs, joined by the link, with the delay and "
                   "loss of the scene's line; one: as one program (default: two if the scene says "
                   "so, and it is neither --fast nor recorded)")
        ->check(CLI::IsMember({"two", "one"}));
  } else {
    app.add_flag("--impaired", a.session.link.is_impaired,
                 "Delay and lose packets as the line of the scene does, to try a far link nearby");
  }
  app.add_option(
         "--domain", a.session.link.domain,
         "DDS domain of the link, the same on both sides (default: 0; with --programs two a "
         "random one)")
      ->check(CLI::Range(0, 230));
  app.add_option("--link", a.session.link.where,
                 "Link between the sides: dds, dds:INTERFACE or dds:INTERFACE,PEER (Cyclone DDS), "
                 "udp or udp:ADDRESS:PORT (of the site). Without more it is on this machine; "
                 "elsewhere it needs --key: docs/two_machines.md")
      ->default_str(runs::default_link())
      ->type_name("LINK")
      ->check(CLI::Validator(runs::link_complaint, "LINK"));
  CLI::Option* key =
      app.add_option(
             "--key", a.session.link.key_file,
             "Key of the link, the same on both sides: a file that teleop key wrote. Packets "
             "are encrypted, and only those by its owners are heard (default: the file "
             "named by the environment variable REPEL_KEY)")
          ->type_name("FILE");
  app.add_flag("--no-key", a.session.link.no_key,
               "No key, even where other machines reach the link: they can drive the robot")
      ->excludes(key);
}

/// What a run prints and writes.
void describe_files(CLI::App& app, Command command, Arguments& a) {
  app.option_defaults()->group("Files");
  app.add_flag("--quiet", a.is_quiet, "No progress and no report on the terminal");
  const auto take = [&a](std::string& file) {
    if (file == "-") {
      file = "/dev/stdout";
      a.is_quiet = true;
    }
    return std::string();
  };
  app.add_option("--report", a.report,
                 "Write the report as JSON to FILE; -: print it, in place of the text")
      ->transform(CLI::Validator(take, ""));
  if (command == Command::station) return;
  app.add_option("--html", a.html, "Write the report as a page with curves to FILE");
  app.add_option("--log", a.choice.run.log,
                 "Write every tick to FILE: a recording if its name ends in .mcap, else CSV");
}

/// What stands in scene files and behind options.
std::string names_text() {
  std::string backends;
  for (const runs::ArmBackend& backend : runs::arm_backends()) {
    backends.append(backends.empty() ? "" : ", ").append(backend.name);
  }
  return "Scenes:" + scene_list() + "\n\nBack ends:\n  " + backends +
         "\n\nDevices (chosen phase by phase in the scene):\n"
         "  spaceball   six rates, scripted\n  torque_arm  force-reflecting lever, scripted\n"
         "  six_axes    six rates of a hand, with force feedback, scripted\n"
         "or, in place of the script, the page of --view and the master of --device\n\n";
}

constexpr const char* ending_text =
    "Files are written as FILE.part and renamed once complete. Ctrl-C, SIGTERM and SIGHUP fade\n"
    "the forces, then the run ends with its report; a second Ctrl-C ends it at once.\n\n"
    "Exit status: 0 it ran, 1 bad scene or file, 2 bad usage, 3 a replay came out otherwise,\n"
    "4 it ran, but a file or the output could not be written whole, 5 it ran, but an arm gained\n"
    "energy from its own control, or had a fault in more than a tenth of its ticks.";

constexpr const char* usage_text =
    "Without a command it is run: teleop SCENE [OPTIONS]. For a file named like a command:\n"
    "teleop run NAME. The options of a command: teleop COMMAND --help\n\n"
    "Common usage:\n"
    "  teleop plates --view                in the live view, driven from the browser\n"
    "  teleop plates --fast --seconds 5    as fast as it goes\n"
    "  teleop plates --rate 1000           at another tick rate [Hz]\n"
    "  teleop plates --backend ode         with another simulated arm\n"
    "  teleop plates --device spacenav     driven by a master in the hand\n"
    "  teleop plates --report report.json  with its report in a file\n"
    "  teleop plates --log run.mcap        recorded, for teleop replay run.mcap\n\n";

/// After all options of a command. @throws CLI::ParseError if they contradict each other
void settle(const CLI::App& app, Command command, Arguments& a) {
  a.command = command;
  if (command == Command::site) a.session.link.side = link::Side::site;
  if (command == Command::station) a.session.link.side = link::Side::station;
  for (const char* option : {"--link", "--domain", "--key", "--no-key"}) {
    if (command != Command::run || a.programs == "two" || app.count(option) == 0) continue;
    throw CLI::ValidationError(std::string(option) +
                               " belongs to: teleop site, teleop station, or "
                               "teleop run with --programs two");
  }
  if (a.programs == "two" && a.choice.run.fast)
    throw CLI::ExcludesError("--programs two", "--fast");
  const std::string insecure = runs::settle_secret(a.session);
  if (!insecure.empty()) throw CLI::ValidationError(insecure);
  runs::require_able(a.choice);
}

}  // namespace

void describe(CLI::App& app, Arguments& a) {
  app.require_subcommand(0, 1);
  app.get_formatter()->label("SUBCOMMAND", "COMMAND");
  for (const auto& [command, name, about] : commands) {
    CLI::App& added = *app.add_subcommand(name, about)->group("Commands");
    added.final_callback([&added, &a, command = command] { settle(added, command, a); });
    if (command == Command::list) {
      added.add_flag("--faults", a.faults,
                     "List the faults that teleop run --fault injects, with their kinds");
      continue;
    }
    if (command == Command::key) {
      added.add_option("file", a.key_file, "File of the key, which must not exist")
          ->required()
          ->type_name("FILE");
      added.footer("Exit status: 0 it is written, 1 it is not, 2 bad usage.");
      continue;
    }
    describe_run(added, command, a);
    if (command == Command::check) {
      added.footer("Exit status: 0 it is sound, 1 it is not, 2 bad usage.");
      continue;
    }
    added.footer((command == Command::run ? names_text() : std::string()) + ending_text);
    describe_view(added, command, a);
    if (command != Command::replay) describe_link(added, command, a);
    describe_files(added, command, a);
  }
  app.footer(usage_text + names_text() + ending_text);  // last: commands inherit it
}

}  // namespace repel::teleop

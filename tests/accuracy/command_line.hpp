// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Command-line parsing of the programs in this folder: options with a number, and --help.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace repel::accuracy {

/// One option that takes a value.
struct Option {
  const char* name;  ///< including its dashes
  const char* help;
  double* number = nullptr;
  std::string* text = nullptr;
  double least = 0.0;
  double most = 9007199254740992.0;  ///< 2^53: whole numbers up to it are exact
};

inline void print_help(const char* what, const std::vector<Option>& options) {
  std::printf("%s\n\n", what);
  for (const Option& o : options) {
    if (o.number != nullptr) {
      std::printf("  %-10s %s (%.17g)\n", o.name, o.help, *o.number);
    } else {
      std::printf("  %-10s %s\n", o.name, o.help);
    }
  }
}

/// Parses the options; ends the program on --help (status 0), and on an unknown argument or a
/// number out of its range (2).
inline void read_command_line(int argc, char** argv, const char* what,
                              const std::vector<Option>& options) {
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--help") == 0) {
      print_help(what, options);
      std::exit(0);
    }
    bool known = false;
    for (const Option& o : options) {
      if (std::strcmp(argv[i], o.name) != 0 || i + 1 == argc) continue;
      char* end = nullptr;
      const char* value = argv[++i];
      if (o.text != nullptr) *o.text = value;
      known = true;
      if (o.number == nullptr) break;
      *o.number = std::strtod(value, &end);
      const bool is_number = end != value && *end == '\0';
      if (is_number && *o.number >= o.least && *o.number <= o.most) break;
      std::fprintf(stderr, "%s: %s is '%s'; allowed: %.17g to %.17g\n", argv[0], o.name, value,
                   o.least, o.most);
      std::exit(2);
    }
    if (known) continue;
    std::fprintf(stderr, "%s: not understood: %s\n", argv[0], argv[i]);
    print_help(what, options);
    std::exit(2);
  }
}

}  // namespace repel::accuracy

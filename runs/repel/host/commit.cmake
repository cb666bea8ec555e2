# SPDX-License-Identifier: BSD-3-Clause
# Writes the commit of SOURCE to OUTPUT; "unknown" outside a git checkout.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE
                ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[
/// @file
/// The commit this program was built from.
#pragma once

namespace repel::host {
inline constexpr const char* commit = "@commit@";
}  // namespace repel::host
]] @ONLY)

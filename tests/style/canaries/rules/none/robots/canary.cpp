// SPDX-License-Identifier: BSD-3-Clause
void write(char* out) { std::snprintf(out, 2, "1"); }

// SPDX-License-Identifier: BSD-3-Clause
// rejected by cppcoreguidelines-avoid-non-const-global-variables
int counter = 0;

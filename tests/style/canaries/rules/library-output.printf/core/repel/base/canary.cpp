// SPDX-License-Identifier: BSD-3-Clause
void shout() { printf("1"); }

// SPDX-License-Identifier: BSD-3-Clause
void shout() { std::cout << 1; }

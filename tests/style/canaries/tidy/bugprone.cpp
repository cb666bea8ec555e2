// SPDX-License-Identifier: BSD-3-Clause
// rejected by bugprone-integer-division
double half() { return 1 / 2; }

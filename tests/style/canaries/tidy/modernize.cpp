// SPDX-License-Identifier: BSD-3-Clause
// rejected by modernize-use-nullptr
int* nothing() { return 0; }

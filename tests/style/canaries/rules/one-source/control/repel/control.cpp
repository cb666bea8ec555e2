// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cell/other.cpp>

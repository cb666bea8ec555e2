// SPDX-License-Identifier: BSD-3-Clause
#include <repel/robots/arm.hpp>

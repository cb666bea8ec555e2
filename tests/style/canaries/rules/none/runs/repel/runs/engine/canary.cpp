// SPDX-License-Identifier: BSD-3-Clause
#include <repel/host/figure.hpp>
#include <repel/runs/options/run_options.hpp>

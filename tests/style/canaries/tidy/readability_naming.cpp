// SPDX-License-Identifier: BSD-3-Clause
// rejected by readability-identifier-naming
struct lower_case {};

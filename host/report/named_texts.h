// SPDX-License-Identifier: Apache-2.0
// Short facts in an order: what a report says of the files it wrote, of the machine, of the options.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace turbid {

/// Name and value, in the order in which they are printed.
using NamedTexts = std::vector<std::pair<std::string, std::string>>;

}  // namespace turbid

// SPDX-License-Identifier: Apache-2.0
// `turbid info --json`.
#pragma once
#include <string>

namespace turbid {

/// `text`: what describe_image or describe_vdb said; its lines become an array.
std::string file_json(const std::string& file, const std::string& kind, const std::string& text);

}  // namespace turbid

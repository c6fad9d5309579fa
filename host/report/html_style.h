// SPDX-License-Identifier: Apache-2.0
// The style sheet of report pages. Private to host/report.
#pragma once

namespace turbid {

extern const char* const kPageStyle;

}  // namespace turbid

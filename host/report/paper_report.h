// SPDX-License-Identifier: Apache-2.0
// The study of the paper's own scheme as a page: a table of what breaks and what the remedy buys, then each in a
// figure.
#pragma once
#include "host/report/document.h"
#include "host/study/paper_scheme.h"

namespace turbid {

/// `quick`: the study was a small one, which the page says.
Document paper_report(const study::PaperStudy&, NamedTexts context, bool quick);

}  // namespace turbid

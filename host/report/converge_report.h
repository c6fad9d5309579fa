// SPDX-License-Identifier: Apache-2.0
// What `turbid converge` found, as a document: errors over levels with reference slopes, errors over time, pictures.
#pragma once
#include <string>
#include <vector>

#include "host/report/document.h"
#include "host/study/refine_scene.h"

namespace turbid {

/// `subject`: the case's or scene's name. `context`: from report_context.
Document converge_document(const std::string& subject, const std::vector<SceneRefinement>&, const NamedTexts& context);

}  // namespace turbid

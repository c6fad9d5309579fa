// SPDX-License-Identifier: Apache-2.0
// Speed against error, and the accuracy of many scenes against photons, as documents.
#pragma once
#include <string>
#include <vector>

#include "host/report/document.h"
#include "host/study/pareto_scene.h"

namespace turbid {

/// `aims`: errors for which a setting is recommended, in falling order.
Document pareto_document(const std::string& scene, const ParetoStudy&, const std::vector<double>& aims,
                         const NamedTexts& context);
Document accuracy_document(const std::vector<AccuracyRow>&, const NamedTexts& context);

}  // namespace turbid

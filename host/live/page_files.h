// SPDX-License-Identifier: Apache-2.0
// The files of the live view's page, compiled in by embed_page.cmake.
#pragma once

namespace turbid {

extern const char* const k_page_html;
extern const char* const k_page_css;
extern const char* const k_page_js;
extern const char* const k_sliders_js;

}  // namespace turbid

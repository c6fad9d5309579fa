// SPDX-License-Identifier: Apache-2.0
// The live view's page: page.html, page.css and page.js, compiled in by embed_page.cmake.
#pragma once

namespace turbid {

extern const char* const kPage_html;
extern const char* const kPage_css;
extern const char* const kPage_js;

}  // namespace turbid

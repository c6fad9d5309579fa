# SPDX-License-Identifier: Apache-2.0
# Writes OUTPUT, a C++ file that holds the texts of FOLDER/page.html, page.css and page.js.
set(code "#include \"host/live/page_files.h\"\nnamespace turbid {\n")
foreach(part html css js)
  file(READ ${FOLDER}/page.${part} text)
  string(APPEND code "const char* const kPage_${part} = R\"turbidpage(${text})turbidpage\";\n")
endforeach()
string(APPEND code "}\n")
file(WRITE ${OUTPUT} "${code}")

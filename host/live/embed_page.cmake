# SPDX-License-Identifier: Apache-2.0
# Writes OUTPUT, a C++ file that holds the texts of the live view's page, which lies in FOLDER.
set(code "#include \"host/live/page_files.h\"\nnamespace turbid {\n")
foreach(file page.html page.css page.js sliders.js)
  file(READ ${FOLDER}/${file} text)
  string(REPLACE "." "_" name ${file})
  string(APPEND code "const char* const k_${name} = R\"turbidpage(${text})turbidpage\";\n")
endforeach()
string(APPEND code "}\n")
file(WRITE ${OUTPUT} "${code}")

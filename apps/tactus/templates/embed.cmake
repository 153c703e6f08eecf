# cmake -DFOLDER=… -DOUTPUT=… -P embed.cmake: every file of the templates' folders as C++.
file(GLOB_RECURSE files RELATIVE ${FOLDER} ${FOLDER}/*/*)
string(CONCAT source "#include \"apps/tactus/templates.h\"\n\nnamespace tactus::app {\n\n"
              "std::span<const Template> templates() {\n  static const Template all[] = {\n")
foreach(file ${files})
  file(READ ${FOLDER}/${file} content)
  string(APPEND source "      {\"${file}\", R\"=====(${content})=====\"},\n")
endforeach()
string(APPEND source "  };\n  return all;\n}\n\n}  // namespace tactus::app\n")
file(WRITE ${OUTPUT} "${source}")

# embed_texts(RESULT FORMAT FILES...): C++ text in which each file's content is a string literal. FORMAT is what is made of
# one file: @name@ is its name without the last extension, . as _, and @literal@ the literal. What is embedded needs no
# place on the disk when the program runs.
function(embed_texts result format)
  set(all "")
  foreach(file ${ARGN})
    get_filename_component(name ${file} NAME_WLE)
    string(REPLACE "." "_" name ${name})
    file(READ ${file} text)
    set(literal "R\"text(${text})text\"")
    string(CONFIGURE "${format}" one @ONLY)
    string(APPEND all "${one}\n")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  endforeach()
  set(${result} "${all}" PARENT_SCOPE)
endfunction()

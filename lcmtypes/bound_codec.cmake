# Rewrites one C++ header that lcm-gen made, so that
# - its decode() checks every count against the bytes that are left before it makes room for it: as generated, a packet of
#   61 bytes that announces 2^31 - 1 elements costs 15 s and 2 GB, and a negative count throws;
# - its encode() and getEncodedSize() throw std::length_error where a list is shorter than its count says, or the count is below 0:
#   as generated, they read behind its end and send what lies there.
# Usage: cmake -DHEADER=x_t.hpp -DSOURCE=x_t.lcm -P bound_codec.cmake
# Fails unless every array and string of the type was found, so that another lcm-gen cannot pass unnoticed.
file(READ ${HEADER} text)
file(READ ${SOURCE} source)

function(count_matches pattern content result)
  string(REGEX MATCHALL "${pattern}" matches "${content}")
  list(LENGTH matches length)
  set(${result} ${length} PARENT_SCOPE)
endfunction()

set(name "[A-Za-z0-9_]+")
set(index "(\\[a[0-9]\\])*")
set(fails "return -1;  // bounded by bound_codec.cmake\n")

# Strings: the length counts the closing zero, so it is at least 1.
string(REGEX REPLACE "if\\((__${name}_len__|__elem_len) > maxlen - pos\\) return -1;\n"
                     "if(\\1 < 1 || \\1 > maxlen - pos) ${fails}" text "${text}")
# Rows of numbers, also the inner ones of a table: the elements are in the message one after the other.
string(REGEX REPLACE
  "(this->${name}${index})\\.resize\\(([^()]+)\\);(\n *tlen = __${name}_decode_array)"
  "if((\\3) < 0 || (\\3) > (maxlen - pos) / (int)sizeof(\\1[0])) ${fails}            \\1.resize(\\3);\\4" text "${text}")
# Tables: no more rows than bytes for them.
string(REGEX REPLACE
  "(this->${name})\\.resize\\(([^()]+)\\);(\n *for \\([^\n]*\n *if\\()([^()]+)(\\) {)"
  "if((\\2) < 0 || (\\4) < 0 || (int64_t)(\\2) * ((\\4) > 0 ? (\\4) : 1) > (maxlen - pos) / (int)sizeof(\\1[0][0])) ${fails}    \\1.resize(\\2);\\3\\4\\5"
  text "${text}")
# Rows of strings: each has its length and its closing zero.
string(REGEX REPLACE
  "(this->${name})\\.resize\\(([^()]+)\\);(\n *for \\([^\n]*\n *int32_t __elem_len;)"
  "if((\\2) < 0 || (\\2) > (maxlen - pos) / 5) ${fails}    \\1.resize(\\2);\\3" text "${text}")
# Structures: the smallest one has all counts zero and all texts empty.
string(REGEX REPLACE
  "(this->(${name}))\\.resize\\(([^()]+)\\);(\n *for \\([^\n]*\n *tlen = this->${name}\\[a0\\]\\._decodeNoHash)"
  "if((\\3) < 0 || (\\3) > (maxlen - pos) / decltype(this->\\2)::value_type{}._getEncodedSizeNoHash()) ${fails}    \\1.resize(\\3);\\4"
  text "${text}")

string(REGEX REPLACE "//[^\n]*" "" fields "${source}")
count_matches("\n *${name} +${name}\\[num_[a-z_]+\\]" "${fields}" num_arrays)
count_matches("\n *${name} +${name}\\[num_[a-z_]+\\]\\[[0-9a-z_]+\\]" "${fields}" num_tables)
count_matches("\n *string " "${fields}" num_strings)
# A table makes room twice, for its rows and in each row, and each has its check.
math(EXPR expected "${num_arrays} + ${num_tables} + ${num_strings}")
count_matches("bounded by bound_codec" "${text}" num_checks)
count_matches("\\.resize\\(" "${text}" num_resizes)
count_matches("\\.assign\\(" "${text}" num_assigns)
math(EXPR num_unsafe "${num_resizes} + ${num_assigns}")
if(NOT num_checks EQUAL expected OR NOT num_checks EQUAL num_unsafe)
  file(REMOVE ${HEADER})
  message(FATAL_ERROR "${SOURCE}: ${expected} arrays and strings, ${num_unsafe} places that make room, but ${num_checks} of "
                      "them could be bounded: lcm-gen writes another form than bound_codec.cmake knows")
endif()

# Encoding: each list against its count, before anything is read.
get_filename_component(type ${SOURCE} NAME_WE)
set(checks "")
function(append_check list count)
  set(throws "throw std::length_error(\"${type}: ${field} does not have ${says} elements\")")
  set(checks "${checks}if(${count} < 0 || ${count} > (int)${list}.size()) ${throws};\n" PARENT_SCOPE)
endfunction()
string(REGEX MATCHALL "${name}\\[num_[a-z_]+\\](\\[[0-9a-z_]+\\])?" lists "${fields}")
foreach(list IN LISTS lists)
  string(REGEX MATCH "^(${name})\\[(num_[a-z_]+)\\](\\[([0-9a-z_]+)\\])?" list "${list}")
  set(field ${CMAKE_MATCH_1})
  set(says ${CMAKE_MATCH_2})
  set(inner "${CMAKE_MATCH_4}")
  set(member "this->${field}")
  append_check("${member}" "this->${says}")
  if(NOT inner STREQUAL "")
    string(APPEND checks "for(int a0 = 0; a0 < this->${says}; a0++) ")
    set(field "a row of ${field}")
    set(says ${inner})
    string(REGEX REPLACE "^num_" "this->num_" inner "${inner}")
    append_check("${member}[a0]" "${inner}")
  endif()
endforeach()
foreach(start "_encodeNoHash(void *buf, int offset, int maxlen) const\n{\n" "_getEncodedSizeNoHash() const\n{\n")
  string(FIND "${text}" "::${start}" place)
  if(place EQUAL -1)
    file(REMOVE ${HEADER})
    message(FATAL_ERROR "${SOURCE}: lcm-gen writes another encode() than bound_codec.cmake knows")
  endif()
  string(REPLACE "::${start}" "::${start}${checks}" text "${text}")
endforeach()
string(REPLACE "#include <lcm/lcm_coretypes.h>\n" "#include <lcm/lcm_coretypes.h>\n#include <stdexcept>\n" text "${text}")
file(WRITE ${HEADER} "${text}")

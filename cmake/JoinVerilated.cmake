# cmake -D DIR=... -D PREFIX=Vx [-D ANY_EVENT=ON] -P: joins the files that Verilator wrote into Vx__joined.cc. Their
# names contain hashes, so a build cannot know them in advance. The joined file also gets the model's rising_edge().
file(GLOB sources "${DIR}/${PREFIX}*.cpp")
list(SORT sources)
set(fast "")
set(slow "")
set(events "")
set(fast_text "")
foreach(source IN LISTS sources)
  cmake_path(GET source FILENAME name)
  file(READ "${source}" text)
  # Coverage counters are atomic although only one thread at a time runs a model, and the locked addition takes most of
  # the run time. So they become plain additions.
  if(text MATCHES "__Vcoverage")
    string(REGEX REPLACE "(vlSymsp->__Vcoverage\\[[0-9]+\\])\\.fetch_add\\(1, std::memory_order_relaxed\\)"
      "\\1.store(\\1.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed)" text "${text}")
    file(WRITE "${source}" "${text}")
  endif()
  if(name MATCHES "__(Slow|Syms|ConstPool)")
    string(APPEND slow "#include \"${name}\"\n")
    # Verilator lists its trigger events in the code, for its own debugging.
    string(REGEX MATCHALL "@\\([a-z]+edge [^)]*\\)" found "${text}")
    list(APPEND events ${found})
  else()
    string(APPEND fast "#include \"${name}\"\n")
    string(APPEND fast_text "${text}")
  endif()
endforeach()
list(REMOVE_DUPLICATES events)
# Besides the clock, only the emergency stop's pin may trigger: it sets a flip-flop. Each clock edge evaluates that
# flip-flop, so a press takes effect at a clock edge.
list(FILTER events EXCLUDE REGEX "^@\\((posedge clk_i or )?posedge [a-z_.]*pressed( or posedge clk_i)?\\)$")
if(NOT ANY_EVENT AND NOT events STREQUAL "@(posedge clk_i)")
  message(FATAL_ERROR "${PREFIX} triggers on \"${events}\"; rising_edge.hpp evaluates @(posedge clk_i) only")
endif()
# A clock of the card executes more code than fits in a first-level instruction cache, and most of its branches are
# rarely taken. Marked as unlikely, they move out of the common path. Headers are included first, because a macro
# replaces the keyword `if`.
string(REGEX MATCHALL "#include \"[^\"]*\"" headers "${fast_text}")
list(REMOVE_DUPLICATES headers)
list(JOIN headers "\n" headers)
string(PREPEND fast "${headers}\n#define if(...) if (__builtin_expect(!!(__VA_ARGS__), 0))\n")
string(APPEND fast "#undef if\n")
# If Verilator's functions are those that rising_edge.hpp knows, rising_edge() calls them directly instead of eval().
set(root "${PREFIX}___024root")
string(APPEND fast "#include \"rising_edge.hpp\"\n")
string(FIND "${fast_text}" "vlSelf->__VnbaTriggered.at(0U)" nba)
string(FIND "${fast_text}" "void ${root}___eval_ico(${root}* vlSelf) {" ico)
if(nba EQUAL -1 OR ANY_EVENT)
  string(APPEND fast "template void trammel::lockstep::rising_edge<${PREFIX}>(${PREFIX}&);\n")
else()
  string(APPEND fast "template <>\nvoid trammel::lockstep::rising_edge<${PREFIX}>(${PREFIX}& dut) {\n")
  if(NOT ico EQUAL -1)
    string(APPEND fast "  evaluate_inputs(*dut.rootp, &${root}___eval_ico);\n")
  endif()
  string(APPEND fast "  evaluate_edge(*dut.rootp, &${root}___eval_nba);\n}\n")
endif()
file(WRITE "${DIR}/${PREFIX}__joined.cc" "${fast}${slow}")

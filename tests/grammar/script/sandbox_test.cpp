#include "solvers/grammar/script/sandbox.h"

#include <gmock/gmock.h>

#include "tests/grammar/script/fixture.h"

namespace geoprior::grammar::script_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

std::string load_failure(const std::string& text, const LuaLimits& limits = {}) {
  try {
    rules_of(text, limits);
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

TEST(GrammarSandbox, LoopsEnd) {
  EXPECT_THAT(failure(tree_rule("while true do end")),
              AllOf(StartsWith("rules.lua:2: rule 'grow', element 'tree-1': runs on after 100"),
                    HasSubstr("instructions")));
  EXPECT_THAT(load_failure("\nrepeat until false"), StartsWith("rules.lua:2: runs on after"));
}

TEST(GrammarSandbox, ElementsOfTheBatchAreAllowedInstructions) {
  const LuaLimits limits{.instructions = 1000, .instructions_per_element = 1000};
  EXPECT_EQ(failure(tree_rule("for i = 1, 2000 do end"), limits), "");
  EXPECT_THAT(failure(tree_rule("for i = 1, 9000 do end"), limits), HasSubstr("runs on"));
}

TEST(GrammarSandbox, WorkInCountsAsInstructions) {
  for (const char* body :
       {"local t = {} for i = 1, 20000 do t[i] = i end while true do table.insert(t, 1, 0) end",
        "table.move({}, 1, 1e15, 2)", "local s = string.rep('a', 9000) while true do s:lower() end",
        "local t = {} for i = 1, 9000 do t[i] = i end while true do table.sort(t) end",
        "local t = {} for i = 1, 9000 do t[i] = i end while true do next(t, 1) end",
        "local s = string.rep('a', 8000) while true do s:find(s .. 'b') end"})
    EXPECT_THAT(failure(tree_rule(body), {.instructions = 1'000'000}), HasSubstr("runs on"))
        << body;
}

TEST(GrammarSandbox, MemoryEnds) {
  const LuaLimits limits{.memory = 4'000'000};
  EXPECT_THAT(failure(tree_rule("local t = {}\nfor i = 1, 1e9 do t[i] = {} end"), limits),
              AllOf(StartsWith("rules.lua:3: rule 'grow', element 'tree-1': needs more memory"),
                    HasSubstr("4000000 bytes")));
  EXPECT_THAT(failure(tree_rule("local s = 'a' while true do s = s .. s end")),
              HasSubstr("makes a text of more than 16384 bytes"));
  EXPECT_THAT(failure(tree_rule("string.rep('abc', 1e9)")),
              StartsWith("rules.lua:2: rule 'grow', element 'tree-1': makes a text"));
  EXPECT_THAT(load_failure("local x = {}\nfor i = 1, 1e7 do x[i] = i end", limits),
              StartsWith("rules.lua:2: needs more memory"));
}

TEST(GrammarSandbox, TheScriptServesOnAfterItFailed) {
  Hierarchy h = wood();
  Transaction undo(h);
  const RuleSet rules =
      rules_of(tree_rule("local t = {}\n"
                         "while b:parameter(1, 'girth') < 1 do t[#t + 1] = {} end"),
               {.memory = 4'000'000});
  EXPECT_THROW(derive(h, undo, rules, {0, Delta::free(shift(1))}), Error);
  h.set_parameter(1, 1, 2);
  EXPECT_NO_THROW(derive(h, undo, rules, {0, Delta::free(shift(1))}));
}

TEST(GrammarSandbox, RecursionEnds) {
  EXPECT_THAT(failure(tree_rule("local function f(n)\nreturn 1 + f(n + 1) end f(1)")),
              AllOf(StartsWith("rules.lua:3: rule 'grow', element 'tree-1': "),
                    HasSubstr("stack overflow")));
  EXPECT_THAT(failure(tree_rule("local t = setmetatable({}, {}) local m = {} "
                                "m.__index = function(x, k) return setmetatable({}, m)[k] end "
                                "return setmetatable({}, m).x")),
              HasSubstr("stack overflow"));
}

TEST(GrammarSandbox, ErrorsNameFileLineRuleAndElement) {
  EXPECT_THAT(failure(tree_rule("b:position(2)\nlocal x = nil + 1")),
              StartsWith("rules.lua:3: rule 'grow', element 'tree-2': attempt to perform "
                         "arithmetic on a nil value"));
  EXPECT_THAT(failure(tree_rule("error('no way')")),
              StartsWith("rules.lua:2: rule 'grow', element 'tree-1': no way"));
  EXPECT_THAT(failure(tree_rule("error('no way', 0)")), StartsWith("rules.lua:2: rule 'grow'"));
  EXPECT_THAT(failure(tree_rule("error({})")), HasSubstr("raises a table instead of a text"));
  EXPECT_THAT(failure(tree_rule("error()")), HasSubstr("raises a nil instead of a text"));
}

TEST(GrammarSandbox, WhatIsWrittenMustBeFiniteAndInItsRange) {
  EXPECT_EQ(failure(tree_rule("\nb:set_position(3, 0/0, 0, 0)")),
            "rules.lua:3: rule 'grow', element 'tree-3': is put to a place that is not finite");
  EXPECT_THAT(
      failure(tree_rule("b:set_parameter(2, 'height', 0/0)")),
      StartsWith("rules.lua:2: rule 'grow', element 'tree-2': parameter 'height' would be"));
  EXPECT_THAT(
      failure(tree_rule("b:set_parameter(2, 'height', 101)")),
      HasSubstr("parameter 'height' would be 101.000000 (allowed: 0.000000 to 100.000000)"));
  EXPECT_THAT(failure(tree_rule("b:set_turn(1, 0, 0, 1, 1)")), HasSubstr("has the norm 1.41"));
  EXPECT_THAT(failure(tree_rule("b:set_turn(1, 0, 0, 1/0, 1)")),
              HasSubstr("argument 4 is inf (allowed: a finite number)"));
  EXPECT_THAT(failure(tree_rule("b:down(1, delta.translate(0, 0/0, 0))")),
              HasSubstr("(allowed: a finite number)"));
}

TEST(GrammarSandbox, UnknownNamesAreErrors) {
  EXPECT_THAT(failure(tree_rule("b:find('yew-1')")),
              AllOf(StartsWith("rules.lua:2: rule 'grow', element 'tree-1': there is no element "
                               "'yew-1'"),
                    HasSubstr("tree-1 to tree-3")));
  EXPECT_THAT(failure(tree_rule("b:position(4)")),
              HasSubstr("there is no element 4 in the batch (allowed: 1 to 3)"));
  EXPECT_THAT(failure(tree_rule("b:position_of(99)")),
              HasSubstr("there is no element of the number 99 (allowed: 0 to 6)"));
  EXPECT_THAT(failure(tree_rule("b:parameter(1, 'hight')")),
              HasSubstr("type 'tree': has no parameter 'hight' (allowed: height, girth)"));
  EXPECT_THAT(failure(tree_rule("b:spawn(1, 'leave', 0,0,0, 0,0,0,1)")),
              HasSubstr("there is no type 'leave' (allowed: wood, tree, leaf)"));
  EXPECT_THAT(failure(tree_rule("b:spawn(1, 'leaf', 0,0,0, 0,0,0,1, {})")),
              HasSubstr("a new 'leaf' needs the parameter 'size'"));
  EXPECT_THAT(failure(tree_rule("b:down(1, delta.set('girth', 1))")),
              HasSubstr("type 'leaf': has no parameter 'girth'"));
  EXPECT_THAT(failure(tree_rule("b:down(1, nil, 5)")),
              HasSubstr("element 'leaf-2' is no child of 'tree-1'"));
  EXPECT_THAT(failure(tree_rule("b:jump(1)")), HasSubstr("method 'jump'"));
  EXPECT_THAT(failure(tree_rule("return hight")), HasSubstr("there is no global 'hight'"));
  EXPECT_THAT(failure(tree_rule("hight = 3")), HasSubstr("a rule may make no new global 'hight'"));
}

TEST(GrammarSandbox, RulesThatAreNoneAreErrors) {
  EXPECT_EQ(load_failure("\nrule{name = 'a', apply = 3}"),
            "rules.lua:2: 'apply' is a number (allowed: a function of the script)");
  EXPECT_THAT(load_failure("rule{name = 'a'}"), HasSubstr("rule 'a': 'apply' is missing"));
  EXPECT_THAT(load_failure("rule{apply = function() end}"), HasSubstr("a rule has no name"));
  EXPECT_THAT(
      load_failure("rule{name = 'a', typ = 'b'}"),
      HasSubstr("a rule has no field 'typ' (allowed: name, type, on, from, phase, follows"));
  EXPECT_THAT(load_failure("rule{name = 'a', on = 'bend', apply = function() end}"),
              HasSubstr("'on' is 'bend' (allowed: identity, free, rigid"));
  EXPECT_THAT(load_failure("rule(3)"), HasSubstr("allowed: a table"));
  EXPECT_THAT(failure(tree_rule("rule{}")), HasSubstr("declared within a rule"));
  EXPECT_THAT(load_failure("for i = 1"), StartsWith("rules.lua:1: "));
  EXPECT_THAT(load_failure("\x1bLua"), HasSubstr("binary chunk"));
}

TEST(GrammarSandbox, PhasesAreKept) {
  EXPECT_THAT(failure(tree_rule("b:up()")), HasSubstr("asks the parent in the phase down"));
  EXPECT_THAT(failure("rule{name = 'w', type = 'wood', phase = 'up', apply = function(b) "
                      "b:down(1) end}"),
              HasSubstr("asks children in the phase up"));
  EXPECT_THAT(failure(tree_rule("b:down(1) b:down(1)")), HasSubstr("asked a second time"));
  EXPECT_THAT(failure("local kept\nrule{name = 'w', type = 'wood', phase = 'down', apply = "
                      "function(b) kept = b b:down(1) end}\n" +
                      tree_rule("kept.position(1)")),
              HasSubstr("a method of the batch is called without it"));
}

TEST(GrammarSandbox, WhatReachesOutsideIsNotThere) {
  for (const char* name : {"io", "os", "require", "package", "debug", "load", "loadstring",
                           "dofile", "loadfile", "collectgarbage", "coroutine", "pcall", "xpcall",
                           "print", "getmetatable", "rawset", "_G", "utf8", "warn"})
    EXPECT_THAT(load_failure("local x = " + std::string(name)),
                HasSubstr("there is no global '" + std::string(name) + "'"));
  for (const char* name : {"string.dump", "string.gsub", "string.gmatch", "string.match",
                           "string.pack", "math.randomseed", "('').dump", "('').gsub"})
    EXPECT_EQ(load_failure("assert(" + std::string(name) + " == nil)"), "") << name;
  EXPECT_THAT(load_failure("local x <const> = _ENV"), HasSubstr("names _ENV"));
}

TEST(GrammarSandbox, LibrariesCannotBeChanged) {
  EXPECT_THAT(load_failure("math.pi = 3"), HasSubstr("a library may not be written ('pi')"));
  EXPECT_THAT(load_failure("setmetatable(math, {})"), HasSubstr("is a library"));
  EXPECT_THAT(load_failure("table.insert(math, 3)"), HasSubstr("may not be written"));
  EXPECT_THAT(failure("string = 3\n" + tree_rule("local x = ('a'):upper()")), "");
}

TEST(GrammarSandbox, MetatablesHaveNothingOfGarbage) {
  for (const char* name : {"__gc", "__mode", "__close", "__len", "__metatable"})
    EXPECT_THAT(load_failure("setmetatable({}, {" + std::string(name) + " = 'k'})"),
                HasSubstr("may not have '" + std::string(name) + "'"));
  EXPECT_EQ(load_failure("local C = {} C.__index = C function C.f() return 3 end\n"
                         "local o = {} assert(setmetatable(o, C) == o and o.f() == 3)"),
            "");
}

TEST(GrammarSandbox, TablesAreWalkedInOrder) {
  EXPECT_EQ(load_failure(R"(
    local t = {[true] = 1, b = 1, a = 1, [2.5] = 1, [-1] = 1, [1] = 1, aa = 1, [false] = 1, [3] = 1}
    local seen = ""
    for k in pairs(t) do seen = seen .. tostring(k) .. " " end
    assert(seen == "-1 1 2.5 3 a aa b false true ", seen)
    seen = ""
    local k = next(t)
    while k ~= nil do seen = seen .. tostring(k) .. " " k = next(t, k) end
    assert(seen == "-1 1 2.5 3 a aa b false true ", seen)
    for key in pairs(t) do t[key] = nil end
    assert(next(t) == nil))"),
            "");
  EXPECT_THAT(load_failure("for k in pairs({[{}] = 1}) do end"),
              HasSubstr("a key of the table is a table"));
}

TEST(GrammarSandbox, SortingIsStable) {
  EXPECT_EQ(load_failure(R"(
    local t = {}
    for i = 1, 1000 do t[i] = {key = i * 7919 % 10, number = i} end
    table.sort(t, function(a, b) return a.key < b.key end)
    for i = 2, 1000 do
      assert(t[i - 1].key < t[i].key or t[i - 1].key == t[i].key and t[i - 1].number < t[i].number)
    end
    local s = {"b", "a", "c"}
    table.sort(s)
    assert(table.concat(s) == "abc")
    table.sort(s, function() return true end) -- no order: any result, no harm
    assert(#s == 3))"),
            "");
}

TEST(GrammarSandbox, TextsShowNoAddresses) {
  EXPECT_EQ(load_failure(R"(
    assert(tostring({}) == "table")
    assert(tostring(math.sin) == "function" and tostring(1.5) == "1.5" and tostring(nil) == "nil")
    assert(string.format("%d %5.2f %s %%", 3, 1.234, "x") == "3  1.23 x %")
    assert(("a.b"):find(".") == 2 and ("abc"):byte(2) == 98 and ("ab"):rep(2) == "abab"))"),
            "");
  EXPECT_THAT(load_failure("string.format('%p', {})"), HasSubstr("the format has '%p'"));
  EXPECT_THAT(load_failure("string.format('%s', {})"), HasSubstr("a number or a text"));
}

TEST(GrammarSandbox, SameBytesAtEachRun) {
  const std::string body = R"(
    local t, n = {}, 0
    for i = 1, 500 do t["k" .. (i * 7919 % 503)] = math.random() end
    for k, v in pairs(t) do n = n * 0.75 + v end
    b:set_parameter(1, "height", n))";
  double first = 0;
  for (int run = 0; run < 5; ++run) {
    Hierarchy h = wood();
    Transaction undo(h);
    derive(h, undo, rules_of(tree_rule(body)), {0, Delta::free(shift(1))});
    if (run == 0) first = h.parameter(1, 0);
    EXPECT_EQ(h.parameter(1, 0), first);
  }
}

}  // namespace
}  // namespace geoprior::grammar::script_test

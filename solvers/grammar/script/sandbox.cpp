#include "solvers/grammar/script/sandbox.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <lua5.4/lua.hpp>
#include <new>
#include <utility>

#include "core/error.h"

namespace geoprior::grammar {
namespace {

constexpr int kHookStep = 1000;
constexpr double kBytesAnInstruction = 64;
constexpr std::size_t kLongestScript = 1 << 20;
/// Chunks are named so within Lua, which shortens long names; messages get the file's name.
constexpr const char* kChunkName = "=script";
constexpr std::string_view kChunkPrefix = "script:";

/// The line of the innermost function of the script; 0: none is running.
int script_line(lua_State* L) {
  lua_Debug frame;
  for (int level = 0; lua_getstack(L, level, &frame) != 0; ++level) {
    lua_getinfo(L, "l", &frame);
    if (frame.currentline > 0) return frame.currentline;
  }
  return 0;
}

}  // namespace

void describe(OptionVisitor& v, LuaLimits& limits) {
  v.value("instructions", limits.instructions,
          {.doc = "instructions of Lua that one call of a rule may take, whatever its batch",
           .min = 1000,
           .max = 2e9});
  v.value("instructions_per_element", limits.instructions_per_element,
          {.doc = "instructions more for each element of the batch", .min = 0, .max = 1e6});
  v.value("memory", limits.memory,
          {.doc = "memory of the script", .unit = "byte", .min = 1 << 18, .max = 2e9});
}

/// What Lua calls outside of functions.
struct LuaSandboxHooks {
  static void* allocate(void* data, void* block, std::size_t old_size, std::size_t size) {
    LuaSandbox& s = *static_cast<LuaSandbox*>(data);
    const std::size_t before = block != nullptr ? old_size : 0;
    if (size == 0) {
      std::free(block);
      s.used_ -= before;
      return nullptr;
    }
    if (size > before) {
      // For a new object, the old size tells its kind.
      const bool text = block == nullptr && old_size == LUA_TSTRING;
      s.work_ += static_cast<double>(size - before) / kBytesAnInstruction;
      if (text && size > LuaSandbox::kLongestText + 64) return refuse(s, LuaSandbox::Refusal::text);
      if (s.used_ - before + size > static_cast<std::size_t>(s.limits_.memory))
        return refuse(s, LuaSandbox::Refusal::memory);
      if (s.L_ != nullptr && s.work_ > s.budget_)
        return refuse(s, LuaSandbox::Refusal::instructions);
    }
    void* moved = std::realloc(block, size);
    // Lua assumes that a block can always be made smaller.
    if (moved == nullptr) return size <= before ? block : refuse(s, LuaSandbox::Refusal::memory);
    s.used_ += size - before;
    return moved;
  }

  static void* refuse(LuaSandbox& s, LuaSandbox::Refusal why) {
    s.refusal_ = why;
    // Errors of memory pass the message handler by.
    if (s.L_ != nullptr) s.line_ = script_line(s.L_);
    return nullptr;
  }

  static void count(lua_State* L, lua_Debug*) {
    LuaSandbox& s = LuaSandbox::of(L);
    s.work_ += kHookStep;
    if (s.work_ <= s.budget_) return;
    s.refusal_ = LuaSandbox::Refusal::instructions;
    lua_pushnil(L);
    lua_error(L);
  }

  static int handle(lua_State* L) {
    LuaSandbox::of(L).line_ = script_line(L);
    return 1;
  }

  /// Its argument is the function that opens the library.
  static int set_up(lua_State* L) {
    const auto open = *static_cast<void (**)(lua_State*)>(lua_touserdata(L, 1));
    lua_settop(L, 0);
    open(L);
    return 0;
  }
};

LuaSandbox::LuaSandbox(std::string name, const LuaLimits& limits, std::uint64_t seed,
                       void (*open_library)(lua_State*))
    : name_(std::move(name)), limits_(limits), seed_(seed), random_(seed, "grammar script") {
  budget_ = std::numeric_limits<double>::infinity();
  lua_State* L = lua_newstate(&LuaSandboxHooks::allocate, this);
  if (L == nullptr) throw Error("there is no memory for a script", name_);
  L_ = L;
  *static_cast<LuaSandbox**>(lua_getextraspace(L)) = this;
  lua_pushcfunction(L, &LuaSandboxHooks::set_up);
  lua_pushlightuserdata(L, &open_library);
  if (lua_pcall(L, 1, 0, 0) == LUA_OK) return;
  lua_close(L);
  throw Error("the library does not fit in " + std::to_string(limits_.memory) + " bytes", name_);
}

LuaSandbox::~LuaSandbox() {
  if (L_ != nullptr) lua_close(L_);
}

LuaSandbox& LuaSandbox::of(lua_State* L) {
  return **static_cast<LuaSandbox**>(lua_getextraspace(L));
}

void LuaSandbox::compile(const std::string& text) {
  // Code that rebinds _ENV is compiled wrongly by Lua 5.4.4.
  if (text.find("_ENV") != std::string::npos)
    throw ScriptFailure{name_, "names _ENV (allowed: globals by their names)"};
  if (text.size() > kLongestScript)
    throw ScriptFailure{name_, "is longer than " + std::to_string(kLongestScript) + " bytes"};
  work_ = 0;
  budget_ = std::numeric_limits<double>::infinity();
  refusal_ = Refusal::none;
  line_ = 0;
  const int status = luaL_loadbufferx(L_, text.data(), text.size(), kChunkName, "t");
  if (status != LUA_OK) throw failure(status);
}

void LuaSandbox::call(int arguments, int results, double instructions) {
  work_ = 0;
  budget_ = instructions;
  refusal_ = Refusal::none;
  line_ = 0;
  const int function = lua_gettop(L_) - arguments;
  lua_pushcfunction(L_, &LuaSandboxHooks::handle);
  lua_insert(L_, function);
  lua_sethook(L_, &LuaSandboxHooks::count, LUA_MASKCOUNT, kHookStep);
  const int status = lua_pcall(L_, arguments, results, function);
  lua_sethook(L_, nullptr, 0, 0);
  budget_ = std::numeric_limits<double>::infinity();
  lua_remove(L_, function);
  if (status != LUA_OK) throw failure(status);
}

void LuaSandbox::charge(double instructions) {
  work_ += instructions;
  if (work_ <= budget_) return;
  refusal_ = Refusal::instructions;
  throw Error("has spent its instructions");
}

void LuaSandbox::keep(const char* what) noexcept {
  std::strncpy(kept_, what, sizeof(kept_) - 1);
  kept_[sizeof(kept_) - 1] = 0;
}

int LuaSandbox::raise() {
  lua_pushstring(L_, kept_);
  return lua_error(L_);
}

ScriptFailure LuaSandbox::failure(int status) {
  std::string what;
  if (lua_type(L_, -1) == LUA_TSTRING) {
    what = lua_tostring(L_, -1);
  } else {
    what = std::string("raises a ") + luaL_typename(L_, -1) + " instead of a text";
  }
  lua_pop(L_, 1);
  if (what.starts_with(kChunkPrefix)) {
    const std::size_t end = what.find(": ", kChunkPrefix.size());
    if (end != std::string::npos) {
      line_ = std::atoi(what.c_str() + kChunkPrefix.size());
      what.erase(0, end + 2);
    }
  }
  if (refusal_ == Refusal::instructions) {
    what = "runs on after " + std::to_string(static_cast<std::int64_t>(work_)) + " instructions";
  } else if (status == LUA_ERRMEM && refusal_ == Refusal::text) {
    what = "makes a text of more than " + std::to_string(kLongestText) + " bytes";
  } else if (status == LUA_ERRMEM) {
    what = "needs more memory than the limit of " + std::to_string(limits_.memory) + " bytes";
  }
  // What a failed call left behind must not count against the next one.
  lua_gc(L_, LUA_GCCOLLECT);
  return {line_ > 0 ? name_ + ":" + std::to_string(line_) : name_, what};
}

double number_argument(lua_State* L, int index) {
  if (lua_type(L, index) != LUA_TNUMBER) wrong_argument(L, index, "a number");
  return lua_tonumber(L, index);
}

double finite_argument(lua_State* L, int index) {
  const double value = number_argument(L, index);
  if (!std::isfinite(value)) wrong_argument(L, index, "a finite number");
  return value;
}

int integer_argument(lua_State* L, int index) {
  int whole = 0;
  const lua_Integer value =
      lua_type(L, index) == LUA_TNUMBER ? lua_tointegerx(L, index, &whole) : 0;
  if (whole == 0 || value < std::numeric_limits<int>::min() ||
      value > std::numeric_limits<int>::max())
    wrong_argument(L, index, "an integer");
  return static_cast<int>(value);
}

const char* text_argument(lua_State* L, int index) {
  if (lua_type(L, index) != LUA_TSTRING) wrong_argument(L, index, "a text");
  return lua_tostring(L, index);
}

void wrong_argument(lua_State* L, int index, const char* allowed) {
  const bool method = lua_type(L, 1) == LUA_TUSERDATA;
  std::string what = luaL_typename(L, index);
  if (what == "number") what = std::to_string(lua_tonumber(L, index));
  if (what == "string") what = "'" + std::string(lua_tostring(L, index)) + "'";
  throw Error("argument " + std::to_string(method ? index - 1 : index) + " is " + what, {},
              allowed);
}

}  // namespace geoprior::grammar

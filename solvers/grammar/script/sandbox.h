#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>

#include "core/options.h"
#include "core/random.h"

struct lua_State;

namespace geoprior::grammar {

struct RuleBinding;

/// What a script may take.
struct LuaLimits {
  int instructions = 10'000'000;
  int instructions_per_element = 2000;
  int memory = 64 << 20;  ///< bytes
};
void describe(OptionVisitor& v, LuaLimits& limits);

/// What went wrong in a script.
struct ScriptFailure {
  std::string where;  ///< file and line
  std::string what;
};

/// A Lua 5.4 state in which foreign text may run: it reaches no file and no clock, ends, and does
/// the same at each run.
///
/// - Limits: instructions by the count hook, memory by the allocator. Bytes that are asked for
/// count
///   as instructions, and so does the work of functions in C, so that no instruction is much dearer
///   than another.
/// - Errors: Lua is compiled as C and leaves a function by longjmp, which skips destructors. Hence
///   what C++ throws is caught in each function that Lua calls (`bound`), its text kept, and the
///   error of Lua raised where no C++ object lives.
/// - Not a wall against defects of the interpreter itself.
/// Used by one thread at a time.
class LuaSandbox {
 public:
  /// Longest text that a script may make (bytes): comparing two texts is one instruction.
  static constexpr std::size_t kLongestText = 16384;

  /// @param name          of the script's file, for messages
  /// @param open_library  makes what scripts have of Lua's library (library.h); called protected
  LuaSandbox(std::string name, const LuaLimits& limits, std::uint64_t seed,
             void (*open_library)(lua_State*));
  ~LuaSandbox();
  LuaSandbox(const LuaSandbox&) = delete;
  LuaSandbox& operator=(const LuaSandbox&) = delete;

  [[nodiscard]] static LuaSandbox& of(lua_State* L);
  [[nodiscard]] lua_State* state() const { return L_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const LuaLimits& limits() const { return limits_; }

  /// Puts the compiled text on the stack. @throws ScriptFailure
  void compile(const std::string& text);
  /// Calls the function that lies below its arguments; nothing is left of them on the stack.
  /// @throws ScriptFailure
  void call(int arguments, int results, double instructions);
  /// Counts work that a function in C is about to do. @throws Error  when it is too much
  void charge(double instructions);

  /// Keeps the text of what was thrown, for `raise`.
  void keep(const char* what) noexcept;
  /// Raises what was kept as an error of Lua. Does not return.
  int raise();

  /// The numbers of math.random, from the start.
  void restart_random() { random_ = RandomStream(seed_, "grammar script"); }
  RandomStream& random() { return random_; }

  RuleBinding* binding = nullptr;  ///< what the functions of the language work on

 private:
  friend struct LuaSandboxHooks;
  enum class Refusal { none, memory, text, instructions };

  ScriptFailure failure(int status);

  std::string name_;
  LuaLimits limits_;
  std::uint64_t seed_;
  RandomStream random_;
  lua_State* L_ = nullptr;
  std::size_t used_ = 0;  ///< bytes
  double work_ = 0;       ///< instructions of the call
  double budget_ = 0;
  Refusal refusal_ = Refusal::none;
  int line_ = 0;  ///< where the script was when it failed; 0: not in it
  char kept_[1024] = {};
};

/// A function that Lua may call, made of one that may throw. In `F`, what raises errors of Lua (it
/// makes tables or texts, or calls functions) stands where nothing that has a destructor lives.
template <int (*F)(lua_State*, LuaSandbox&)>
int bound(lua_State* L) {
  LuaSandbox& sandbox = LuaSandbox::of(L);
  try {
    return F(L, sandbox);
  } catch (const std::exception& e) {
    sandbox.keep(e.what());
  } catch (...) {
    sandbox.keep("an exception that is no std::exception");
  }
  return sandbox.raise();
}

// Arguments of bound functions. They raise no error of Lua: they throw Error, naming the argument,
// counted from 1 without the object before the colon.
double number_argument(lua_State* L, int index);
/// A finite one.
double finite_argument(lua_State* L, int index);
int integer_argument(lua_State* L, int index);
/// Alive as long as it is on the stack.
const char* text_argument(lua_State* L, int index);
[[noreturn]] void wrong_argument(lua_State* L, int index, const char* allowed);

}  // namespace geoprior::grammar

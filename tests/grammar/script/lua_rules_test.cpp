#include "solvers/grammar/script/lua_rules.h"

#include <gmock/gmock.h>

#include "tests/grammar/script/fixture.h"

namespace geoprior::grammar::script_test {
namespace {

using testing::HasSubstr;

DerivationReport derive_on(Hierarchy& h, const std::string& text, const Edit& edit) {
  Transaction undo(h);
  return derive(h, undo, rules_of(text), edit);
}

TEST(GrammarScript, RulesWriteTheirBatch) {
  Hierarchy h = wood();
  const auto report = derive_on(h, R"(
    rule{name = "stand", type = "tree", on = "free", phase = "down", apply = function(b)
      for i = 1, #b do
        local x, y, z = b:position(i)
        local mx, my = b:map(i, x, y, z)
        b:set_position(i, mx, my, z)
        b:set_parameter(i, "height", b:parameter(i, "height") + i)
      end
    end})",
                                {0, Delta::free(shift(1, 2, 3))});
  EXPECT_EQ(report.rewrites, 5);  // the root up and down, three trees
  EXPECT_EQ(h.position(3), Eigen::Vector3d(5, 2, 0));
  EXPECT_EQ(h.parameter(3, 0), 15);
  EXPECT_EQ(h.position(6), Eigen::Vector3d(4, 0, 9));  // nobody asked the leaves
}

TEST(GrammarScript, GuardsChooseTheRule) {
  const std::string text = R"(
    bounds("tre*")
    local function height(value)
      return function(b) b:set_parameter(1, "height", value) end
    end
    rule{name = "a", type = "tree", on = "extrude", phase = "down", apply = height(1)}
    rule{name = "b", type = "tr*", from = "parent", phase = "down", apply = height(2)}
    rule{name = "c", type = "tree", from = "user", phase = "down", follows = true,
         apply = height(3)}
    rule{name = "d", type = "tree", from = "user", phase = "down", apply = height(4)})";
  Hierarchy h = wood();
  derive_on(h, text, {1, Delta::extrude(0, 1)});
  EXPECT_EQ(h.parameter(1, 0), 1);
  derive_on(h, text, {0, Delta::free(shift(1))});
  EXPECT_EQ(h.parameter(1, 0), 2);
  derive_on(h, text, {1, Delta::translate({1, 0, 0})});
  EXPECT_EQ(h.parameter(1, 0), 4);
}

TEST(GrammarScript, SymbolsGoDownWithWhatIsAsked) {
  Hierarchy h = wood();
  derive_on(h, R"(
    rule{name = "each its own", type = "wood", phase = "down", apply = function(b)
      for k, tree in ipairs(b:children(1)) do b:down_translate(1, tree, 0, k, 0) end
    end}
    rule{name = "leaf shrinks", type = "tree", phase = "down", apply = function(b)
      for i = 1, #b do
        b:set_position(i, b:map(i, b:position(i)))
        b:down(i, delta.set("size", 0.125 * i))
      end
    end})",
            {0, Delta::free(shift(1))});
  EXPECT_EQ(h.position(1), Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(h.position(3), Eigen::Vector3d(4, 3, 0));
  EXPECT_EQ(h.parameter(6, 0), 0.375);
}

TEST(GrammarScript, ChildrenThatAreAskedOneByOneAreOneBatch) {
  Hierarchy h = wood(100);
  Transaction undo(h);
  const auto report = derive(h, undo, rules_of(R"(
    rule{name = "turn all", type = "wood", phase = "down", apply = function(b)
      for _, tree in ipairs(b:children(1)) do
        b:down_rigid(1, tree, 1, 0, 0, rotation.about(0, 0, 1, math.pi / 2))
      end
    end})"),
                             {0, Delta::free(shift(1))}, true);
  EXPECT_EQ(report.trace.at(2).count, 100);
  EXPECT_NEAR((h.position(100) - Eigen::Vector3d(1, 198, 0)).norm(), 0, 1e-12);
}

TEST(GrammarScript, SymbolsGoUpUntilARuleAbsorbsThem) {
  Hierarchy h = wood();
  const auto report = derive_on(h, R"(
    rule{name = "leaf pulls", type = "leaf", phase = "up", apply = function(b)
      b:up(delta.translate(0, 0, b:value()))
    end}
    rule{name = "tree gives way", type = "tree", phase = "up", from = "child",
         apply = function(b) b:absorb(delta.extrude("height", 2)) end}
    rule{name = "tree grows", type = "tree", phase = "down", on = "extrude", apply = function(b)
      if b:asked_parameter() == "height" and b:sender() == 4 and b:edited() == 4 then
        b:set_parameter(1, "height", b:parameter(1, "height") + b:value())
      end
    end})",
                                {4, Delta::extrude(0, 0.5)});
  EXPECT_EQ(report.turned_at, 1);
  EXPECT_EQ(h.parameter(1, 0), 12);
}

TEST(GrammarScript, ElementsComeAndGo) {
  Hierarchy h = wood();
  const auto report = derive_on(h, R"(
    rule{name = "replant", type = "wood", phase = "down", apply = function(b)
      local trees = b:children(1)
      local new = b:spawn(1, "tree", 9, 0, 0, 0, 0, 0, 1, {height = 3, girth = 1})
      assert(new == 2 and b:parent(new) == b:element(1))
      b:set_position(new, 8, 0, 0)
      b:remove_child(1, trees[1])
      assert(#b:children(1) == 3 and b:absent_children(1)[1] == trees[1])
    end})",
                                {0, Delta::free(shift(1))});
  EXPECT_EQ(report.spawned, 1);
  EXPECT_EQ(report.removed, 2);
  EXPECT_EQ(h.position(7), Eigen::Vector3d(8, 0, 0));
  EXPECT_FALSE(h.present(1));
  derive_on(h, R"(
    rule{name = "restore", type = "wood", phase = "down", apply = function(b)
      local i = b:restore(1, b:absent_children(1)[1])
      b:set_parameter(i, "height", 1)
    end})",
            {0, Delta::free(shift(1))});
  EXPECT_TRUE(h.present(1));
  EXPECT_EQ(h.parameter(1, 0), 1);
}

TEST(GrammarScript, TheObjectCanBeRead) {
  Hierarchy h = wood();
  h.set_name(2, "oak");
  h.set_tag(3, {1, Tag::Follow::stop});
  derive_on(h, R"(
    rule{name = "look", type = "wood", phase = "down", apply = function(b)
      local oak = b:find("oak")
      assert(oak == 2 and b:label(1) == "tree-1" and b:type_of(oak) == "tree")
      assert(b:type() == "wood" and b:kind() == "free" and b:phase() == "down")
      assert(b:parent(1) == nil and b:parent_of(oak) == 0 and b:children_of(oak)[1] == 5)
      assert(b:tag(3) == "stop" and b:tag(oak) == nil and b:present(oak))
      assert(b:parameter_of(oak, "girth") == 0.5 and b:parameter_now(oak, "height") == 11)
      assert(b:position_of(oak) == 2 and b:position_now(oak) == 2)
      assert(select(4, b:turn_of(oak)) == 1 and select(7, b:pose_now(oak)) == 1)
      local keys = b:keys_of(oak)
      assert(#keys == 6 and keys[1] == 2 and keys[6] == 11 and b:keys_now(oak)[6] == 11)
      assert(b:count() == 1 and #b == 1 and not b:follows() and b:origin() == "user")
      assert(b:point_count(0) == 0)
    end})",
            {0, Delta::free(shift(1))});
}

TEST(GrammarScript, MapsAreAskedWithTheirDerivative) {
  Eigen::Affine3d m = Eigen::Affine3d::Identity();
  m.linear() << 0, -2, 0, 2, 0, 0, 0, 0, 1;
  m.translation() = Eigen::Vector3d(1, 2, 3);
  for (const Delta& delta :
       {Delta::free(std::make_shared<AffineMap>(m)), Delta{DeltaKind::affine, {}, m}}) {
    Hierarchy h = wood();
    derive_on(h, R"(
      rule{name = "wood", type = "wood", phase = "down", apply = function(b) b:down(1) end}
      rule{name = "tree", type = "tree", phase = "down", apply = function(b)
        local x, y, z, xx, xy, xz, yx = b:map_jacobian(2, 2, 0, 0)
        assert(x == 1 and y == 6 and z == 3 and xx == 0 and xy == -2 and yx == 2)
        local px, py, pz, qx, qy, qz, qw = b:mapped(2)
        assert(px == 1 and py == 6 and pz == 3)
        b:set_pose(2, px, py, pz, qx, qy, qz, qw)
        b:set_turn(1, select(4, b:map_rotation(1, 0, 0, 0)))
      end})",
              {0, delta});
    for (const int tree : {1, 2})
      EXPECT_NEAR(h.turn(tree).angularDistance(Eigen::Quaterniond(
                      Eigen::AngleAxisd(std::acos(0.), Eigen::Vector3d::UnitZ()))),
                  0, 1e-12);
  }
}

TEST(GrammarScript, RotationsAreUnitQuaternions) {
  // A quarter turn about z takes x to y; its quaternion's z is sqrt(1/2).
  EXPECT_NEAR(value_of(R"(
    local q = {rotation.about(0, 0, 1, math.pi / 2)}
    local x, y = rotation.apply(q[1], q[2], q[3], q[4], 1, 0, 0)
    assert(math.abs(x) < 1e-15)
    local ix, iy, iz, iw = rotation.inverse(q[1], q[2], q[3], q[4])
    local px, py, pz, pw = rotation.product(q[1], q[2], q[3], q[4], ix, iy, iz, iw)
    assert(math.abs(pw - 1) < 1e-15)
    local _, _, tz = rotation.twist(q[1], q[2], q[3], q[4], 0, 0, 1)
    local _, _, mz = rotation.of_matrix(0, -3, 0, 3, 0, 0, 0, 0, 3))",
                       "y + tz * tz + mz * mz"),
              2, 1e-12);
}

TEST(GrammarScript, ConstantsComeFromOutside) {
  Hierarchy h = wood();
  Transaction undo(h);
  const RuleSet rules =
      rules_of(tree_rule("b:set_parameter(1, 'height', constants.a[1] + #constants.a)"), {}, 1,
               {{"a", {4.5, 7}}});
  derive(h, undo, rules, {0, Delta::free(shift(1))});
  EXPECT_EQ(h.parameter(1, 0), 6.5);
}

TEST(GrammarScript, NothingIsKeptFromOneDerivationToTheNext) {
  Hierarchy h = wood();
  Transaction undo(h);
  const RuleSet rules = rules_of(R"(
    local calls, memory = 0, {}
    total = 0
    rule{name = "count", type = "tree", phase = "down", apply = function(b)
      calls, total = calls + 1, total + 1
      memory[#memory + 1] = 1
      b:set_parameter(1, "height", calls + total + #memory + math.random())
    end})");
  derive(h, undo, rules, {0, Delta::free(shift(1))});
  const double first = h.parameter(1, 0);
  EXPECT_GE(first, 3);
  EXPECT_LT(first, 4);
  derive(h, undo, rules, {0, Delta::free(shift(1))});
  EXPECT_EQ(h.parameter(1, 0), first);
}

TEST(GrammarScript, RandomNumbersAreTheSeeds) {
  EXPECT_EQ(value_of("", "math.random()", 3), value_of("", "math.random()", 3));
  EXPECT_NE(value_of("", "math.random()", 3), value_of("", "math.random()", 4));
  EXPECT_EQ(value_of("local least, most = 9, 0 for i = 1, 200 do local r = math.random(2, 4) "
                     "least, most = math.min(least, r), math.max(most, r) end",
                     "10 * least + most"),
            24);
}

/// The example of docs/writing-rules.md.
constexpr const char* kWorkedExample = R"lua(
-- Trees lean with the gesture, but by at most eight degrees, and stand where it takes them.
local most = math.rad(8)

bounds("conifer") -- a gesture on one tree concerns no other

rule{
  name = "forest asks its trees", type = "forest", phase = "down",
  apply = function(b) b:down(1) end
}

rule{
  name = "conifer leans a little", type = "conifer", on = "free", phase = "down",
  apply = function(b)
    for i = 1, #b do
      local _, _, ground = b:position(i)
      local x, y, _, qx, qy, qz, qw = b:mapped(i)
      b:set_position(i, x, y, ground)
      -- Where the map's rotation takes the vertical, and the axis about which it tilts it.
      local ux, uy, uz = rotation.apply(qx, qy, qz, qw, 0, 0, 1)
      local lean = math.acos(math.max(-1, math.min(1, uz)))
      if ux ~= 0 or uy ~= 0 then
        local rx, ry, rz, rw = rotation.about(-uy, ux, 0, math.min(lean, most))
        b:set_turn(i, rotation.product(rx, ry, rz, rw, b:turn(i)))
      end
    end
  end
}
)lua";

TEST(GrammarScript, TheWorkedExampleOfTheGuideKeepsItsPromises) {
  Hierarchy h({{.name = "forest"}, {.name = "conifer"}});
  h.add(0, -1, {});
  for (int i = 0; i < 3; ++i) h.add(1, 0, {{2. * i, i - 1., 0}});
  Eigen::Affine3d tilt = Eigen::Affine3d::Identity();
  tilt.rotate(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()));
  derive_on(h, kWorkedExample, {0, Delta::free(std::make_shared<AffineMap>(tilt))});
  for (int tree = 1; tree <= 3; ++tree) {
    const Eigen::Vector3d up = h.turn(tree) * Eigen::Vector3d::UnitZ();
    EXPECT_NEAR(std::acos(up.z()), 8 * std::acos(-1.) / 180, 1e-12);
    EXPECT_LT(up.y(), 0);
    EXPECT_NEAR(h.position(tree).y(), (tree - 2) * std::cos(0.5), 1e-12);
    EXPECT_EQ(h.position(tree).z(), 0);
  }
}

/// A map that runs a derivation of its own whenever it is asked.
class DerivingMap final : public SpatialMap {
 public:
  explicit DerivingMap(const RuleSet& rules) : rules_(rules) {}
  [[nodiscard]] Eigen::Vector3d at(const Eigen::Vector3d& x) const override {
    Hierarchy h = wood();
    Transaction undo(h);
    derive(h, undo, rules_, {0, Delta::free(shift(1))});
    return x;
  }

 private:
  const RuleSet& rules_;
};

TEST(GrammarScript, OneScriptServesOneDerivationAtATime) {
  const RuleSet rules = rules_of(tree_rule("b:map(1, 0, 0, 0)"));
  Hierarchy h = wood();
  Transaction undo(h);
  try {
    derive(h, undo, rules, {1, Delta::free(std::make_shared<DerivingMap>(rules))});
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("serves another derivation at the same time"));
  }
}

}  // namespace
}  // namespace geoprior::grammar::script_test

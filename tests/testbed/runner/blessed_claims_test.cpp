// What is claimed cannot be moved after it was blessed: each mutation of a claim fails `check`.
#include "testbed/runner/reference/blessed_claims.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "testbed/runner/reference/parser.h"
#include "testbed/runner/reference/reference.h"
#include "testbed/runner/reference/text.h"
#include "tests/testbed/toy_home.h"

namespace geoprior {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

ClaimRecord decided(const std::string& in, bool holds = true, const std::string& null = "n") {
  ClaimRecord claim;
  claim.text = "small";
  claim.case_name = in;
  claim.holds = holds;
  claim.null.variant = null;
  claim.null.verdict = Discrimination::discriminates;
  return claim;
}

TEST(BlessedClaims, EveryChangeIsALine) {
  const BlessedClaims blessed = bless_claims({decided("p"), decided("q")});
  EXPECT_THAT(changed_claims({decided("p"), decided("q")}, blessed), IsEmpty());
  EXPECT_THAT(changed_claims({decided("p")}, blessed),
              ElementsAre("claim 'small', case 'q': is not decided here any more"));
  EXPECT_THAT(changed_claims({decided("p"), decided("q"), decided("r")}, blessed),
              ElementsAre(HasSubstr("case 'r': is decided here, and was not")));
  EXPECT_THAT(changed_claims({decided("p"), decided("q", false)}, blessed),
              ElementsAre(HasSubstr("case 'q': falls short, when it was blessed it was: holds")));
  EXPECT_THAT(changed_claims({decided("p"), decided("q", true, "diverging")}, blessed),
              ElementsAre(HasSubstr("its null is 'diverging', when it was blessed it was 'n'")));
  ClaimRecord excepted = decided("q");
  excepted.excepted = "too coarse";
  EXPECT_THAT(changed_claims({decided("p"), excepted}, blessed),
              ElementsAre(HasSubstr("is excepted, when it was blessed it was not")));
}

TEST(BlessedClaims, OfCasesThatAgreeAreOneLine) {
  BlessedSet set;
  set.blessing = {"c1", "first"};
  const BlessedClaim holds{ClaimOutcome::holds, false, "n", Graded::frames, 0.35};
  BlessedClaim closer = holds;
  closer.least = 0.3;
  set.claims["round"] = {{"n=1", holds}, {"n=2", closer}, {"n=3", holds}};
  const std::string text = reference_text({{"full", set}});
  EXPECT_THAT(text, HasSubstr("claim n=1|n=3 holds - n frames 0.35 \"round\"\n"
                              "claim n=2 holds - n frames 0.3 \"round\"\n\nend 2\n"));
  const Reference read = parse_reference(text, "r.txt");
  EXPECT_EQ(reference_text(read), text);
  EXPECT_EQ(read.at("full").claims.at("round").at("n=3").least, 0.35);
}

TEST(BlessedClaims, StandInTheReferenceALineEach) {
  BlessedSet set;
  set.blessing = {"c1", "first"};
  set.claims["a \"short\" claim"]["n=1"] = {ClaimOutcome::not_told_apart, true, "n", Graded::frames,
                                            0.35};
  set.claims["of a study"][""] = {ClaimOutcome::falls_short, false, "", Graded::not_graded, 0};
  const std::string text = reference_text({{"quick", set}});
  EXPECT_THAT(text, HasSubstr("claim n=1 not-told-apart excepted n frames 0.35 "
                              "\"a \\\"short\\\" claim\"\n"
                              "claim - falls-short - - - - \"of a study\"\n\nend 2\n"));
  const Reference read = parse_reference(text, "r.txt");
  EXPECT_EQ(reference_text(read), text);
  EXPECT_EQ(read.at("quick").claims.at("a \"short\" claim").at("n=1").least, 0.35);
  const auto error = [&](const std::string& line) -> std::string {
    try {
      (void)parse_reference(
          "geoprior reference 5\n\nset quick\nblessed c \"r\"\n" + line + "\n\nend 1\n", "r.txt");
    } catch (const std::exception& e) {
      return e.what();
    }
    return "none";
  };
  EXPECT_EQ(error("claim p holds - n - - \"t\""), "none");
  EXPECT_THAT(error("claim p hold - n - - \"t\""), HasSubstr("r.txt:5: 'hold' is no word"));
  EXPECT_THAT(error("claim p holds - n - \"t\""), HasSubstr("r.txt:5: is no line of this kind"));
}

/// A disc in two cases; the claim discriminates in both.
class BlessedClaimsOfProgram : public testing::Test {
 protected:
  void write(const std::string& claim, const std::string& sweep_values = "[8, 32]") const {
    home_.write("experiments/toy-circle/disc.toml",
                toy::disc_experiment(
                    "segments = 16",
                    "[[variant]]\nname = \"square\"\nmethod = \"polygon\"\nrole = \"null\"\n"
                    "options = { segments = 4 }\n"
                    "[[variant]]\nname = \"half\"\nmethod = \"polygon\"\n"
                    "options = { segments = 5, scale = 0.5 }\n"
                    "[[sweep]]\nkey = \"variant.polygon.options.segments\"\nvalues = " +
                        sweep_values + "\n" + toy::kPlotted +
                        "[[claim]]\ntext = \"round\"\nmetric = \"radius_error\"\n"
                        "variant = \"polygon\"\n" +
                        claim));
  }
  [[nodiscard]] std::string check(const std::string& more = "") const {
    const toy::Outcome outcome = home_.run("check toy-circle/disc" + more);
    return (outcome.code == 0 ? "passes" : "fails") + std::string(": ") + outcome.err;
  }
  toy::Home home_;
};

TEST_F(BlessedClaimsOfProgram, MutationsOfTheClaimFailTheCheck) {
  const std::string good = "value = 0.2\nnull = \"square\"\n";
  write(good);
  EXPECT_THAT(home_.run("bless toy-circle/disc --reason first").code, 0);
  EXPECT_THAT(check(" --mutations"), HasSubstr("passes"));

  write("value = 0.2\nnull = \"half\"\n");
  EXPECT_THAT(check(), testing::AllOf(HasSubstr("fails"), HasSubstr("its null is 'half'")));
  write(good + "except = [{ cases = [\"segments=8\"], reason = \"coarse\" }]\n");
  EXPECT_THAT(check(), testing::AllOf(HasSubstr("fails"), HasSubstr("is excepted")));
  write(good, "[32]");
  EXPECT_THAT(check(), testing::AllOf(HasSubstr("fails"),
                                      HasSubstr("'segments=8': is not decided here any more")));
  write("value = 0.1\nnull = \"square\"\n");
  EXPECT_THAT(check(), testing::AllOf(HasSubstr("fails"), HasSubstr("falls short, when it was")));
}

TEST_F(BlessedClaimsOfProgram, AnExceptedCaseMayFallShort) {
  write(
      "value = 0.1\nnull = \"square\"\n"
      "except = [{ cases = [\"segments=8\"], reason = \"coarse\" }]\n");
  ASSERT_THAT(home_.run("bless toy-circle/disc --reason first").code, 0);
  EXPECT_THAT(check(), HasSubstr("passes"));
  const toy::Outcome run = home_.run("run toy-circle/disc --no-pictures");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("claims   holds in 2, falls short in 1 (1 excepted)"));
  EXPECT_THAT(run.err, HasSubstr("excepted: coarse"));
}

TEST_F(BlessedClaimsOfProgram, ALimitFarFromTheValueNeedsAReason) {
  // Of the radius 2 the polygon of 8, the worst, is off by 0.15, the half disc by more than 1.
  write("value = 1\nnull = \"half\"\n");
  const toy::Outcome refused = home_.run("bless toy-circle/disc --reason first");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, testing::AllOf(HasSubstr("disc.toml"), HasSubstr("'round' is held by"),
                                          HasSubstr("5 times at most")));
  EXPECT_FALSE(std::filesystem::exists(home_.root() / "results/reference/toy-circle/disc.txt"));
  write("value = 1\nnull = \"half\"\nslack = \"half a disc is far\"\n");
  EXPECT_EQ(home_.run("bless toy-circle/disc --reason first").code, 0);
}

TEST_F(BlessedClaimsOfProgram, AGradeThatMovedFailsTheCheckOfMutations) {
  // Points at 0.5 + 0.5 s of the radius 2, to a tenth of which the polygon of 16 comes.
  const std::string claim = "value = 0.2\nnull = \"square\"\n";
  const auto with_input = [&](const std::string& input) {
    write(claim);
    const std::string text = toy::Home::read(home_.root() / "experiments/toy-circle/disc.toml");
    home_.write("experiments/toy-circle/disc.toml", "input = \"" + input + "\"\n" + text);
  };
  with_input("half");
  ASSERT_THAT(home_.run("bless toy-circle/disc --reason first").code, 0);
  EXPECT_THAT(check(" --mutations"), HasSubstr("passes"));
  with_input("square");
  EXPECT_THAT(check(), HasSubstr("passes")) << "without mutations grades are not looked at";
  EXPECT_THAT(check(" --mutations"), testing::AllOf(HasSubstr("fails"), HasSubstr("its grade is")));
}

}  // namespace
}  // namespace geoprior

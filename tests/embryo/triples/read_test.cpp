#include "solvers/embryo/triples/read.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "core/error.h"

namespace geoprior::embryo {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr std::string_view kReadTurtle = R"(@prefix e: <urn:geoprior:embryo#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
# a comment with ] and "
e:Kidney a e:EmbryologicalEntity ;
  rdfs:label "kidney"@en, "ni\u00E8re \"x\"\n" ;
  e:order 3 ; e:ratio 0.5 ; e:big 1e3 ;
  e:dormant true .
e:Key e:geometry [ a e:Point ;
    e:position ( 1
      2 3 ) ] .
)";

constexpr std::string_view kReadRdfXml = R"(<?xml version="1.0"?>
<rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"
  xmlns:e="urn:geoprior:embryo#" xmlns:rdfs="http://www.w3.org/2000/01/rdf-schema#">
 <e:EmbryologicalEntity rdf:about="urn:geoprior:embryo#Kidney">
  <rdfs:label xml:lang="en">kidney</rdfs:label>
  <e:order rdf:datatype="http://www.w3.org/2001/XMLSchema#integer">3</e:order>
 </e:EmbryologicalEntity>
</rdf:RDF>
)";

/// Lines of an N-Triples text in alphabetical order: what does not depend on terms' numbers.
std::vector<std::string> read_lines(const Graph& graph) {
  std::istringstream in(to_ntriples(graph));
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  std::ranges::sort(lines);
  return lines;
}

std::string read_refusal(std::string_view text, RdfFormat format, const ReadLimits& limits = {}) {
  try {
    read_graph(text, format, "file", limits);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

Term read_local(const Graph& graph, const std::string& name) {
  return graph.dictionary().find_local(name).value();
}

TEST(ReadTurtle, GivesTermsWithTheirDatatypes) {
  const Graph graph = read_graph(kReadTurtle, RdfFormat::turtle, "file");
  const Term kidney = read_local(graph, "Kidney");
  const Dictionary& terms = graph.dictionary();
  EXPECT_EQ(terms.datatype(*graph.object(kidney, read_local(graph, "order"))),
            std::string(kXsd) + "integer");
  EXPECT_EQ(terms.datatype(*graph.object(kidney, read_local(graph, "ratio"))),
            std::string(kXsd) + "decimal");
  EXPECT_EQ(terms.datatype(*graph.object(kidney, read_local(graph, "big"))),
            std::string(kXsd) + "double");
  EXPECT_EQ(terms.datatype(*graph.object(kidney, read_local(graph, "dormant"))),
            std::string(kXsd) + "boolean");
  // Eight of the kidney, two of the key and its node, seven of a list of three.
  EXPECT_EQ(graph.size(), 7 + 1 + 1 + 1 + 6);
}

TEST(ReadTurtle, KnowsTheLineOfEachTriple) {
  const Graph graph = read_graph(kReadTurtle, RdfFormat::turtle, "file");
  const Term kidney = read_local(graph, "Kidney"), key = read_local(graph, "Key");
  EXPECT_EQ(graph.line_of(kidney), 4);
  EXPECT_EQ(graph.line_of(kidney, read_local(graph, "order")), 6);
  EXPECT_EQ(graph.line_of(kidney, read_local(graph, "dormant")), 7);
  const Term geometry = *graph.object(key, read_local(graph, "geometry"));
  EXPECT_EQ(graph.line_of(geometry, read_local(graph, "position")), 9);
  Term cell = *graph.object(geometry, read_local(graph, "position"));
  const Term first = *graph.dictionary().find_iri(std::string(kRdf) + "first");
  EXPECT_EQ(graph.line_of(cell, first), 9) << "the number ends where the line does";
  cell = *graph.object(cell, *graph.dictionary().find_iri(std::string(kRdf) + "rest"));
  EXPECT_EQ(graph.line_of(cell, first), 10);
}

TEST(ReadTurtle, ComesBackFromItsNTriples) {
  const Graph graph = read_graph(kReadTurtle, RdfFormat::turtle, "file");
  const Graph again = read_graph(to_ntriples(graph), RdfFormat::ntriples, "file");
  EXPECT_EQ(read_lines(graph), read_lines(again));
}

TEST(ReadRdfXml, GivesTheTriplesOfTheSameTurtle) {
  const Graph graph = read_graph(kReadRdfXml, RdfFormat::rdfxml, "file");
  const Graph turtle = read_graph(
      "@prefix e: <urn:geoprior:embryo#> .\n"
      "e:Kidney a e:EmbryologicalEntity ; e:order 3 ;\n"
      "  <http://www.w3.org/2000/01/rdf-schema#label> \"kidney\"@en .",
      RdfFormat::turtle, "file");
  EXPECT_EQ(read_lines(graph), read_lines(turtle));
  EXPECT_EQ(graph.line_of(read_local(graph, "Kidney"), read_local(graph, "order")), 6);
}

TEST(ReadTurtle, NamesTheLineOfWhatIsMalformed) {
  EXPECT_THAT(read_refusal("<urn:a> <urn:b> <urn:c> .\n<urn:a> <urn:b> .", RdfFormat::turtle),
              StartsWith("file:2: malformed"));
  EXPECT_THAT(read_refusal("\n\n<urn:a> <urn:b> \"open .\n", RdfFormat::turtle),
              StartsWith("file:3: malformed"));
  EXPECT_THAT(read_refusal("\n<urn:a> <urn:b> <urn:c>", RdfFormat::turtle),
              StartsWith("file:2: malformed"));
  EXPECT_THAT(read_refusal("\nx:a x:b x:c .", RdfFormat::turtle),
              HasSubstr("file:2: the prefix of 'x:a' is not declared"));
  EXPECT_THAT(read_refusal("<a> <urn:b> <urn:c> .", RdfFormat::turtle),
              HasSubstr("file:1: the relative IRI <a>"));
  EXPECT_THAT(read_refusal("<urn:a> <urn:b> \"\xff\xfe\" .", RdfFormat::turtle),
              StartsWith("file:1: malformed"));
  EXPECT_THAT(read_refusal(std::string("\n<urn:a> <urn:b>\0 <urn:c> .", 26), RdfFormat::turtle),
              HasSubstr("file:2: a byte 0"));
}

TEST(ReadNTriples, RefusesTurtle) {
  EXPECT_THAT(read_refusal("<urn:a> <urn:b> <urn:c> .\n<urn:a> <urn:b> [] .", RdfFormat::ntriples),
              StartsWith("file:2: malformed"));
}

TEST(ReadRdfXml, NamesTheLineOfWhatIsMalformed) {
  std::string text(kReadRdfXml);
  text.replace(text.find("</rdfs:label>"), 13, "</rdfs:lab>");
  EXPECT_THAT(read_refusal(text, RdfFormat::rdfxml), StartsWith("file:5: malformed"));
  EXPECT_THAT(read_refusal("", RdfFormat::rdfxml), HasSubstr("malformed"));
  EXPECT_THAT(read_refusal("<a/>", RdfFormat::rdfxml), HasSubstr("accepted"));
}

TEST(ReadRdfXml, RefusesRelativeNamesAndEntitiesOfOtherFiles) {
  std::string text(kReadRdfXml);
  text.replace(text.find("urn:geoprior:embryo#Kidney"), 26, "Kidney");
  EXPECT_THAT(read_refusal(text, RdfFormat::rdfxml), HasSubstr("the relative IRI <Kidney>"));
  EXPECT_THAT(read_refusal("<!DOCTYPE r [\n<!ENTITY x SYSTEM \"file:///etc/passwd\">]>\n<r>&x;</r>",
                           RdfFormat::rdfxml),
              HasSubstr("file:2: an entity of another file"));
}

TEST(ReadRdfXml, RefusesWhatNTriplesCannotSay) {
  const auto replaced = [](const std::string& what, const std::string& by) {
    std::string text(kReadRdfXml);
    return text.replace(text.find(what), what.size(), by);
  };
  EXPECT_THAT(read_refusal(replaced("\"en\"", "\"..\""), RdfFormat::rdfxml),
              HasSubstr("malformed: the language '..'"));
  EXPECT_THAT(read_refusal(replaced("XMLSchema#integer", "XML Schema"), RdfFormat::rdfxml),
              HasSubstr("malformed: the IRI"));
  EXPECT_THAT(read_refusal(replaced("http://www.w3.org/2001/XMLSchema#integer", "integer"),
                           RdfFormat::rdfxml),
              HasSubstr("the relative IRI <integer>"));
}

TEST(ReadRdfXml, IsNotBlownUpByEntities) {
  std::string text = "<?xml version=\"1.0\"?>\n<!DOCTYPE r [<!ENTITY e0 \"0123456789\">\n";
  for (int i = 1; i < 12; ++i) {
    text += "<!ENTITY e" + std::to_string(i) + " \"";
    for (int k = 0; k < 10; ++k) text += "&e" + std::to_string(i - 1) + ";";
    text += "\">\n";
  }
  text +=
      "]><rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\" xmlns:e=\"urn:e#\">"
      "<e:A rdf:about=\"urn:a\"><e:b>&e11;</e:b></e:A></rdf:RDF>";
  EXPECT_THAT(read_refusal(text, RdfFormat::rdfxml), StartsWith("file"));
}

TEST(ReadLimits, NameWhatIsAllowed) {
  ReadLimits limits;
  limits.bytes = 10;
  EXPECT_THAT(read_refusal("<urn:a> <urn:b> <urn:c> .", RdfFormat::turtle, limits),
              HasSubstr("a file of 25 bytes (allowed: 10)"));
  limits = {};
  limits.triples = 1;
  EXPECT_THAT(read_refusal("<urn:a> <urn:b> <urn:c>,\n<urn:d> .", RdfFormat::turtle, limits),
              HasSubstr("file:2: too many triples (allowed: 1)"));
  limits = {};
  limits.text = 8;
  EXPECT_THAT(read_refusal("<urn:a> <urn:b> \"123456789\" .", RdfFormat::turtle, limits),
              HasSubstr("file:1: a text of 9 bytes (allowed: 8)"));
}

TEST(ReadLimits, HoldForNesting) {
  const auto nested = [](int depth) {
    std::string text = "# [[[[ and \"(((\n<urn:a> <urn:b> ";
    for (int i = 0; i < depth; ++i) text += i % 2 == 0 ? "[ <urn:(b> " : "( ";
    text += "\"[\\\"[[\"";
    for (int i = depth; i-- > 0;) text += i % 2 == 0 ? " ]" : " )";
    return text + " .\n";
  };
  EXPECT_EQ(read_refusal(nested(64), RdfFormat::turtle), "accepted");
  EXPECT_THAT(read_refusal(nested(65), RdfFormat::turtle),
              HasSubstr("file:2: nested too deeply (allowed: 64 levels)"));
  EXPECT_THAT(read_refusal(std::string(1 << 20, '['), RdfFormat::turtle),
              HasSubstr("nested too deeply"));
  std::string xml;
  for (int i = 0; i < 100000; ++i) xml += "<a>";
  EXPECT_THAT(read_refusal(xml, RdfFormat::rdfxml), HasSubstr("nested too deeply"));
}

TEST(ReadInto, KeepsBlankNodesOfTwoFilesApart) {
  const std::string_view text = "_:b1 <urn:p> \"x\" . [] <urn:p> \"x\" .";
  Graph graph = read_graph(text, RdfFormat::turtle, "one");
  EXPECT_EQ(graph.size(), 2);
  read_into(graph, text, RdfFormat::turtle, "two");
  EXPECT_EQ(graph.size(), 4);
  read_into(graph, "<urn:a> <urn:p> \"x\" .", RdfFormat::ntriples, "three");
  read_into(graph, "<urn:a> <urn:p> \"x\" .", RdfFormat::ntriples, "four");
  EXPECT_EQ(graph.size(), 5);
}

TEST(RdfFormats, AreKnownByTheEnding) {
  EXPECT_EQ(format_of("a.ttl"), RdfFormat::turtle);
  EXPECT_EQ(format_of("a.b.nt"), RdfFormat::ntriples);
  EXPECT_EQ(format_of("a.owl"), RdfFormat::rdfxml);
  EXPECT_THROW(format_of("a.json"), Error);
}

}  // namespace
}  // namespace geoprior::embryo

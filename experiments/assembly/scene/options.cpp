#include "experiments/assembly/scene/options.h"

namespace geoprior::assembly {

void describe(OptionVisitor& v, PiecesOptions& options) {
  v.value("count", options.count, {.doc = "number of pieces", .min = 1, .max = 100000});
  v.value("least", options.least, {.doc = "fewest parts of a piece", .min = 2, .max = 100000});
  v.value("most", options.most, {.doc = "most parts of a piece", .min = 2, .max = 100000});
}

void describe(OptionVisitor& v, Survey& options) {
  v.value("across", options.across,
          {.doc = "whether substructures of all models are inserted into each, or only its own"});
  v.value("pairs", options.pairs,
          {.doc = "whether replacements by substructures that are alike are counted apart"});
  v.value("outputs", options.outputs,
          {.doc = "whether distinct assemblies are counted of all consistent replacements, those "
                  "that do not close among them"});
  v.value("embeds", options.embeds,
          {.doc = "whether replacements with several seams are placed, and held against "
                  "`scene.rules` where they close"});
}

void describe(OptionVisitor& v, AssemblySceneOptions& options) {
  v.value("inputs", options.inputs,
          {.doc = "files of assemblies (.toml, .json, .xtc, .glb, .gltf), and folders of layouts "
                  "(.xtc)",
           .required = true,
           .named = Named::file_or_folder});
  v.value("models", options.models,
          {.doc = "names of the models that are taken from the inputs; empty: all"});
  v.value("least_parts", options.least_parts,
          {.doc = "models with fewer parts are left out", .min = 1, .max = 100000});
  v.value("most_parts", options.most_parts,
          {.doc = "models with more parts are left out", .min = 1, .max = 100000});
  describe_group(v, "pieces", options.pieces,
                 {.doc = "connected pieces that are cut out of the models at random, in place of "
                         "them; absent: whole models"});
  describe_group(v, "rules", options.rules, {.doc = "what makes an assembly a valid one"});
  describe_group(v, "guide", options.guide,
                 {.doc = "what is wanted of a new assembly beside its being valid"});
  describe_group(v, "survey", options.survey,
                 {.doc = "lists what there is in each model; absent: variations are made"});
}

}  // namespace geoprior::assembly

#include "testbed/external/options.h"

namespace geoprior {

void describe(OptionVisitor& v, ExternalOptions& o) {
  v.value(
      "frames", o.frames,
      {.doc = "folder of frames, or numbered files (\"out/frame_%04d.ply\") of one part; beside "
              "the experiment file, of a command in its working folder (there \"out\" where "
              "nothing is said); {case} and {variant} stand for their names"});
  v.value("command", o.command,
          {.doc = "program and arguments that make the frames, started without a shell in a "
                  "folder of the run; needs --allow-commands"});
  v.value("part", o.part,
          {.doc = "the part that numbered files are; absent: the first that the topic asks for"});
  v.value("parameters", o.parameters,
          {.doc = "parameters of numbered files; absent: of frames.csv beside them, else those of "
                  "the scene, else the files' own"});
  v.value("correspondence", o.correspondence,
          {.doc = "a .csv whose column \"vertex\" has for each vertex of the scene the number of "
                  "its vertex in the frames (from 0); absent: they are the same"});
  v.value("time_limit_s", o.time_limit_s,
          {.doc = "the command and all that it started are ended after so long",
           .unit = "s",
           .min = 0.1,
           .max = 1e7});
  v.value("output_limit_MB", o.output_limit_MB,
          {.doc = "most that the command may write below its working folder",
           .unit = "MB",
           .min = 0.001,
           .max = 1e7});
}

}  // namespace geoprior

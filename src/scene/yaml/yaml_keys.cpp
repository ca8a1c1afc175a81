// SPDX-License-Identifier: BSD-3-Clause
#include "scene/yaml/yaml_keys.hpp"

#include "scene/yaml/generators/body_keys.hpp"

namespace ergotic::scene {

const KeyNames& sceneKeys() {
  static const KeyNames kKeys = {"ergotic",    "name",     "about",  "gestural_rate", "speakers",
                                 "parameters", "sections", "mats",   "generators",    "lias",
                                 "agents",     "ports",    "inputs", "outputs",       "truths"};
  return kKeys;
}

const KeyNames& aboutKeys() {
  static const KeyNames kKeys = {"title", "author", "licence", "description",
                                 "hands", "play",   "sources", "picture"};
  return kKeys;
}

const KeyNames& cameraKeys() {
  static const KeyNames kKeys = {"from", "at"};
  return kKeys;
}

const KeyNames& parameterKeys() {
  static const KeyNames kKeys = {"value", "range", "unit"};
  return kKeys;
}

const KeyNames& sectionKeys() {
  static const KeyNames kKeys = {"rate",   "geometry", "pose",  "gravity",
                                 "medium", "sleep",    "modes", "start"};
  return kKeys;
}

const KeyNames& portKeys() {
  static const KeyNames kKeys = {"mat",         "axis",  "slice", "offset", "position_scale",
                                 "force_scale", "filter"};
  return kKeys;
}

const KeyNames& filterKeys() {
  static const KeyNames kKeys = {"mass", "frequency", "damping_ratio", "section"};
  return kKeys;
}

const KeyNames& agentKeys() {
  static const KeyNames kKeys = {"mat",    "stiffness", "damping", "axis", "section",
                                 "filter", "points",    "gesture", "loop", "period"};
  return kKeys;
}

const KeyNames& gestureKeys() {
  static const KeyNames kKeys = {"file", "slice", "tick_rate"};
  return kKeys;
}

const KeyNames& inputKeys() {
  static const KeyNames kKeys = {"mat", "quantity", "channel", "axis", "gain"};
  return kKeys;
}

const KeyNames& outputKeys() {
  static const KeyNames kKeys = {"at",  "quantity", "channel", "channels", "speakers",
                                 "pan", "axis",     "gain",    "radiation"};
  return kKeys;
}

const KeyNames& bendKeys() {
  static const KeyNames kKeys = {"type",      "between", "weights",
                                 "stiffness", "damping", "rest_length"};
  return kKeys;
}

const KeyNames& stretchKeys() {
  static const KeyNames kKeys = {"type", "of", "spacing", "hardening"};
  return kKeys;
}

const KeyNames& meshKeys() {
  static const KeyNames kKeys = {"type",
                                 "name",
                                 "section",
                                 "rows",
                                 "columns",
                                 "spacing",
                                 "at",
                                 "neighbours",
                                 "mass",
                                 "stiffness",
                                 "diagonal_stiffness",
                                 "damping",
                                 "rest_length_ratio",
                                 "scheme",
                                 "edges"};
  return kKeys;
}

const KeyNames& chapletKeys() {
  static const KeyNames kKeys = {"type", "name", "section", "from", "mass", "at"};
  return kKeys;
}

const KeyNames& resonatorKeys() {
  static const KeyNames kKeys = {"type",     "name",   "section", "pitch",
                                 "partials", "places", "at",      "ring"};
  return kKeys;
}

const KeyNames& limpStringKeys() {
  static const KeyNames kKeys = {
      "type",    "name", "section",           "masses", "mass", "stiffness", "frequency", "coarse",
      "damping", "loss", "rest_length_ratio", "scheme", "from", "to",        "pluck",     "ends"};
  return kKeys;
}

KeyNames tunedStringKeys() {
  return withBodyKeys({"masses", "mass", "impedance", "tension", "length", "inharmonicity", "from",
                       "to", "pluck", "ends"});
}

KeyNames barKeys() {
  return withBodyKeys({"masses", "mass", "ends", "ratios", "from", "to"});
}

KeyNames membraneKeys() {
  return withBodyKeys(
      {"shape", "cells", "mass", "neighbours", "load", "spacing", "at", "hardening", "strain"});
}

KeyNames plateKeys() {
  return withBodyKeys(
      {"edges", "cells", "mass", "poisson", "spacing", "at", "hardening", "thickness", "shape"});
}
KeyNames roundPlateKeys() {
  return withBodyKeys({"edges", "mass", "poisson", "radius", "at", "shape"});
}

const KeyNames& fretsKeys() {
  static const KeyNames kKeys = {"type", "name", "along", "count", "height", "nut", "damping"};
  return kKeys;
}

const KeyNames& barrierKeys() {
  static const KeyNames kKeys = {"type", "name", "along", "curve", "damping"};
  return kKeys;
}

const KeyNames& bridgeKeys() {
  static const KeyNames kKeys = {"type", "name", "section",   "of",         "end",
                                 "mat",  "mass", "stiffness", "resistance", "keep_pitch"};
  return kKeys;
}

}  // namespace ergotic::scene

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

/// The keys of every part of a scene: what its reader allows, and what the schema tells editors.
namespace ergotic::scene {

using KeyNames = std::vector<std::string>;
/// Words for types, each with the keys of such an element.
using KeysOfTypes = std::vector<std::pair<std::string, KeyNames>>;

const KeyNames& sceneKeys();
const KeyNames& aboutKeys();
const KeyNames& cameraKeys();  ///< `picture` of `about`
const KeyNames& parameterKeys();
const KeyNames& sectionKeys();
const KeyNames& portKeys();
const KeyNames& filterKeys();  ///< keys of the filter of a port
const KeyNames& agentKeys();
const KeyNames& gestureKeys();  ///< keys of the gesture of an agent
const KeyNames& inputKeys();
const KeyNames& outputKeys();
const KeyNames& bendKeys();
const KeyNames& stretchKeys();
const KeyNames& meshKeys();
const KeyNames& chapletKeys();
const KeyNames& resonatorKeys();
const KeyNames& limpStringKeys();  ///< keys of strings made of masses and springs
const KeyNames& fretsKeys();
const KeyNames& barrierKeys();
const KeyNames& bridgeKeys();
KeyNames tunedStringKeys();
KeyNames barKeys();
KeyNames membraneKeys();
KeyNames plateKeys();  ///< of rectangular ones
KeyNames roundPlateKeys();

KeysOfTypes keysOfMats();
KeysOfTypes keysOfLias();
/// Keys of generators; none for one whose keys only its reader knows.
KeysOfTypes keysOfGenerators();

}  // namespace ergotic::scene

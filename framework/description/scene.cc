#include "framework/description/scene.h"

namespace tactus::description {
namespace {

bool covers(const Party& pair, const Party& party) {
  if (pair == party) return true;
  return pair.object < 0 && pair.link < 0 && party.link >= 0;
}

}  // namespace

ContactMaterial materialOf(const Scene& scene, const Party& one, const Party& other, ContactMaterial usual) {
  for (const ContactPair& pair : scene.pairs) {
    const bool speaks = (covers(pair.one, one) && covers(pair.other, other)) ||
                        (covers(pair.one, other) && covers(pair.other, one));
    if (!speaks) continue;
    usual.stiffness = pair.stiffness.value_or(usual.stiffness);
    usual.dissipation = pair.dissipation.value_or(usual.dissipation);
    usual.friction = pair.friction.value_or(usual.friction);
    usual.rolling = pair.rolling.value_or(usual.rolling);
  }
  return usual;
}

}  // namespace tactus::description

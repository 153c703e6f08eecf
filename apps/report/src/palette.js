/** Lines of plots: told apart by people of every colour vision (Okabe & Ito), darkened for white paper. */
export const lines = ['#1f6fb4', '#e07b1a', '#1a8f6a', '#b3507d', '#8a7a00', '#5b5bd6', '#7a7a74', '#c0392b', '#3aa6c9',
  '#a0632b', '#4d8f1a', '#8b4fb0'];

export const objects = ['#d9c6a3', '#a8bf93', '#b7a7cf', '#9fbcd3', '#d6a995', '#c7c38c'];

const viridis = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129],
  [92, 200, 99], [170, 220, 50], [253, 231, 37]];

/** Viridis, by linear interpolation: [r, g, b] of 0 … 1. */
export function viridisAt(fraction) {
  const at = Math.min(1, Math.max(0, fraction || 0)) * (viridis.length - 1);
  const low = Math.min(viridis.length - 2, Math.floor(at));
  return viridis[low].map((value, i) => (value + (at - low) * (viridis[low + 1][i] - value)) / 255);
}

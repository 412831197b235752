// SPDX-License-Identifier: Apache-2.0
// Perceptually uniform colour maps (viridis and inferno of matplotlib, CC0), by their anchors.

const VIRIDIS = ["#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779",
  "#6ece58", "#b5de2b", "#fde725"];
const INFERNO = ["#000004", "#1b0c41", "#4a0c6b", "#781c6d", "#a52c60", "#cf4446", "#ed6925",
  "#fb9b06", "#f7d13d", "#fcffa4"];

// Okabe and Ito, 2008: told apart by everyone.
export const ESTIMATE = "#d55e00";
export const TRUTH = "#56b4e9";
export const ODOMETRY = "#cc79a7";

type Rgb = [number, number, number];

const parse = (hex: string): Rgb => [
  parseInt(hex.slice(1, 3), 16), parseInt(hex.slice(3, 5), 16), parseInt(hex.slice(5, 7), 16),
];

/** 256 colours between the anchors. */
function table(anchors: string[]): Rgb[] {
  const colours = anchors.map(parse);
  return Array.from({ length: 256 }, (_, i) => {
    const place = (i / 255) * (colours.length - 1);
    const k = Math.min(Math.floor(place), colours.length - 2);
    const [a, b] = [colours[k]!, colours[k + 1]!];
    const share = place - k;
    return [0, 1, 2].map((c) => Math.round(a[c]! + share * (b[c]! - a[c]!))) as Rgb;
  });
}

export const viridis = table(VIRIDIS);
export const inferno = table(INFERNO);

export const css = ([r, g, b]: Rgb): string => `rgb(${r},${g},${b})`;

/** `weight` of a particle against the heaviest one of its cloud, as one of `steps` classes. */
export function weightClass(weight: number, heaviest: number, steps: number): number {
  if (!(heaviest > 0)) return 0;
  return Math.min(steps - 1, Math.max(0, Math.floor((weight / heaviest) * steps)));
}

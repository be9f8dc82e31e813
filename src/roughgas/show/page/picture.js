// A small picture of a scene, from the names of its effects.

const DISKS = [[20, 20, 40], [52, 14, 200], [88, 24, 300], [34, 42, 120], [70, 44, 10], [98, 52, 250],
  [18, 62, 80], [50, 66, 330], [80, 68, 160]];

function shape(name, attributes) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  return element;
}

function arrow(x, y, u, v) {
  const tip = [x + u, y + v], [a, b] = [u, v].map(one => 5 * one / Math.hypot(u, v));
  return shape("path", { class: "arrow",
    d: `M${x} ${y}L${tip}M${tip[0] - a - b / 2} ${tip[1] - b + a / 2}L${tip}L${tip[0] - a + b / 2} ${tip[1] - b - a / 2}` });
}

const both = (x, y, length) => [arrow(x, y, 0, length), arrow(x, y, 0, -length)];
const bar = (x, y, width, height) => shape("rect", { class: "bar", x, y, width, height });

const PARTS = {
  gravity: () => [arrow(126, 20, 0, 24)],
  floor: () => [bar(6, 80, 108, 5), ...both(126, 76, 12)],
  walls: () => [bar(2, 4, 4, 82), bar(114, 4, 4, 82)],
  shaken_walls: () => [bar(2, 4, 4, 82), bar(114, 4, 4, 82), ...both(126, 45, 16)],
  shear: () => [arrow(40, 1, 40, 0), arrow(80, 89, -40, 0)],
  thermostat: () => [arrow(28, 26, 12, 9), arrow(62, 50, -12, 9), arrow(90, 40, 3, -12)],
};

function pictureOf({ description, dimension, effects }) {
  const picture = shape("svg", { viewBox: "0 -4 136 98", role: "img", "aria-label": description });
  picture.append(shape("rect", { class: "box", x: 6, y: 4, width: 108, height: 81 }));
  for (const [x, y, angle] of DISKS) {
    picture.append(shape("circle", { class: "disk", cx: x + 2, cy: y, r: 8 }));
    const turn = angle * Math.PI / 180, end = [x + 2 + 7 * Math.cos(turn), y + 7 * Math.sin(turn)];
    if (dimension === 2 && effects.includes("spin")) picture.append(shape("path", { class: "arrow", d: `M${x + 2} ${y}L${end}` }));
    if (dimension === 3) picture.append(shape("circle", { class: "light", cx: x - 1, cy: y - 3, r: 2.5 }));
  }
  for (const effect of effects) picture.append(...(PARTS[effect]?.() ?? []));
  return picture;
}

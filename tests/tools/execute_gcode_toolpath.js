// Executes a Grbl program with gcode-toolpath and prints its motion.
//
// usage: node execute_gcode_toolpath.js FILE      (NODE_PATH: where gcode-toolpath is)
//
// L or A for every motion in order, R (rapid) or F (feed), start, end and (of arcs) centre as x y z in mm. It knows lines,
// arcs in the three planes and units; feeds, dwells, offsets, cycles and errors it does not.
const fs = require('fs');
const module_ = require('gcode-toolpath');
const Toolpath = module_.default || module_;

const at = (p) => `${p.x.toFixed(9)} ${p.y.toFixed(9)} ${p.z.toFixed(9)}`;
const way = (modal) => (modal.motion === 'G0' ? 'R' : 'F');
const lines = [];
const toolpath = new Toolpath({
  addLine: (modal, from, to) => lines.push(`L ${way(modal)} ${at(from)} ${at(to)}`),
  addArcCurve: (modal, from, to, centre) =>
    lines.push(`A ${modal.motion === 'G2' ? 'C' : 'W'} ${at(from)} ${at(to)} ${at(centre)}`),
});
toolpath.loadFromString(fs.readFileSync(process.argv[2], 'utf8'), (error) => {
  if (error) {
    console.error(String(error));
    process.exit(1);
  }
  console.log(lines.join('\n'));
});

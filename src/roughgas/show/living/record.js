// Record of R over time: a series, its steady window, a mean and its standard error.

const HISTORY = 480; // largest number of stored values: beyond it, pairs are averaged
const CUTS = [0.1, 0.2, 0.3, 0.4, 0.5]; // candidates for the share of the transient in a series
const SETTLED = 2, DOUBTED = 3.5; // largest drift, in sigmas, at which a gas becomes, or remains, steady
const LEAST_SAMPLES = 24, LEAST_BLOCKS = 8, LEAST_TIMES = 10; // needed for a mean and its error

const meanOf = values => values.reduce((sum, one) => sum + one, 0) / values.length;

// Blocking with overlapping blocks, as in roughgas.statistics.errors: {error, blocks, time}, the error of
// the mean of a correlated series, the number of blocks, and the correlation time in samples.
function blocking(series) {
  const n = series.length, mean = meanOf(series), sums = [0];
  let naive = 0;
  for (const one of series) { sums.push(sums.at(-1) + one - mean); naive += (one - mean) ** 2 / (n * (n - 1)); }
  if (!(Math.max(...series) > Math.min(...series))) return { error: n < 2 ? NaN : 0, blocks: n, time: 1 };
  for (let length = 1; ; length = Math.ceil(1.3 * length)) {
    let squares = 0;
    for (let i = length; i <= n; i++) squares += ((sums[i] - sums[i - length]) / length) ** 2;
    const variance = length * squares / ((n - length) * (n - length + 1)), time = variance / naive;
    if (length ** 3 > 2 * n * time * time || Math.ceil(1.3 * length) * 4 > n) {
      return { error: Math.sqrt(variance * (1 + Math.min(time / (2 * length), 0.5))), blocks: n / length, time };
    }
  }
}

// Half width of the 95 % interval in standard errors, for errors from a number of blocks: Student's t, by
// the formula of Wallace, Ann. Math. Stat. 30, 1121 (1959).
function student(blocks) {
  const freedom = blocks - 1, sigmas = 1.96 * (8 * freedom + 3) / (8 * freedom + 1);
  return Math.sqrt(freedom * Math.expm1(sigmas * sigmas / freedom));
}

// Whether the means of the first and last thirds of a series agree within `sigmas` of the noise, and the
// noise is below half of the mean: as in roughgas.statistics.equilibration.
function isSteady(series, sigmas) {
  const third = Math.floor(series.length / 3), late = series.slice(-2 * third), middle = (late.length - 1) / 2;
  const mean = meanOf(late), last = meanOf(late.slice(third)), change = last - meanOf(series.slice(0, third));
  let along = 0, square = 0;
  late.forEach((one, i) => { along += (i - middle) * one; square += (i - middle) ** 2; });
  const { error, blocks } = blocking(late.map((one, i) => one - mean - along / square * (i - middle)));
  const noise = 2 * error * Math.sqrt(blocks / (blocks - 1));
  return Math.abs(change) <= sigmas * noise + 1e-12 && Math.abs(change) + 2 * noise <= Math.max(0.5 * Math.abs(last), 1e-12);
}

class Record {
  // begun: its first time; step: time between samples; group: samples that make a value,
  // such as a period of the drive; signals: columns of a sample that must be steady; more: other columns.
  constructor(begun, step, group, signals, more = []) {
    Object.assign(this, { begun, step, group, signals, due: begun + step, rows: [], latest: null, from: null, known: false });
    this.columns = [...signals, ...more];
    this.end = this.judged = begun;
    this.startValue();
  }

  startValue() { this.sums = this.columns.map(() => 0); this.count = 0; }

  // Time that a value spans.
  get width() { return this.step * this.group; }

  // Adds the sample of the time `due`; R is the first of the signals.
  add(seen) {
    this.columns.forEach((name, k) => { this.sums[k] += seen[name]; });
    this.due += this.step;
    if (++this.count < this.group) return;
    this.rows.push(this.sums.map(one => one / this.group));
    this.latest = this.rows.at(-1)[0];
    this.end = this.begun + this.rows.length * this.width;
    this.startValue();
    if (this.rows.length === HISTORY) {
      this.rows = this.rows.filter((_, i) => i % 2 === 0).map((row, i) => row.map((one, k) => (one + this.rows[2 * i + 1][k]) / 2));
      this.group *= 2;
    }
    if (this.end - this.begun > 1.1 * (this.judged - this.begun)) this.judge();
  }

  // Sets `from`, the start of the steady window: the earliest cut after which all signals are steady (P.
  // Heidelberger and P. D. Welch, Oper. Res. 31, 1109, 1983), or null. A gas that was steady remains so up
  // to a larger drift.
  judge() {
    const sigmas = this.from === null ? SETTLED : DOUBTED;
    this.judged = this.end;
    const cut = CUTS.map(share => Math.ceil(share * this.rows.length)).find(first => this.rows.length - first >= LEAST_SAMPLES
      && this.signals.every((_, k) => isSteady(this.rows.slice(first).map(row => row[k]), sigmas)));
    this.from = cut === undefined ? null : this.begun + cut * this.width;
  }

  // Mean of R over [from, end], its standard error, and half of its 95 % interval, both NaN if
  // too little was measured; null while the gas is not steady.
  average() {
    if (this.from === null) return null;
    const series = this.steady("R"), { error, blocks, time } = blocking(series);
    this.known ||= error === 0 || blocks >= LEAST_BLOCKS && series.length >= LEAST_TIMES * time;
    const sure = this.known ? error : NaN;
    return { mean: meanOf(series), error: sure, half: sure && sure * student(blocks), from: this.from, end: this.end };
  }

  // R averaged over the collisions in the same window, q B/(A + q B) of the means A and B of v_t^2 and
  // v_r^2, and half of its interval from the linearised ratio, as in roughgas.simulation.energies; null
  // without a window.
  collisional(q) {
    if (!this.average() || !this.columns.includes("sliding")) return null;
    const [sliding, spinning] = ["sliding", "spinning"].map(name => this.steady(name));
    const A = meanOf(sliding), B = meanOf(spinning), mean = q * B / (A + q * B);
    if (!(A > 0 && B > 0)) return null;
    const { error, blocks } = blocking(sliding.map((one, i) => mean * (1 - mean) * (spinning[i] / B - one / A)));
    return { mean, half: this.known ? error * student(blocks) : NaN };
  }

  // Values of a column in the steady window.
  steady(name) {
    const k = this.columns.indexOf(name);
    return this.rows.slice(Math.round((this.from - this.begun) / this.width)).map(row => row[k]);
  }
}

// Runs the firmware on an emulated RP2040 with a model of an ST7789 panel on its SPI bus.
//
//     node emulate.mjs <folder of the firmware> frames.raw width height out.ppm [program]
//
// frames.raw holds the expected pictures, one after the other, as big-endian RGB565. Every frame that arrives, by
// either program, is compared with its own; the last one is written to out.ppm. Prints the cycles of drawing alone and
// of sending alone, which `measure` marks by a pin, and those from the last pixel of a frame to the last pixel of the
// next one. Fails if a pixel differs, if a blocking frame does not take as long as both, or if a frame with DMA takes
// more than 5 % longer than the longer of both.
//
// With the name of a program, it runs that one, compares its frames, and prints the cycles of each but the first.
//
// Where time is from: the core's instructions are timed by rp2040js, without waits for flash or for RAM that DMA reads
// too. rp2040js paces DMA by the SPI's FIFO, but lets the SPI send a byte in no time. So the SPI is modelled here: a
// byte takes its eight bits at the rate that the firmware has set, and the next one follows without a gap, as in SPI
// modes 1 and 3.
import { readFileSync, writeFileSync } from "node:fs";
import { RP2040, GPIOPinState } from "rp2040js";

const [folder, frames, widthText, heightText, out, program] = process.argv.slice(2);
const [width, height] = [Number(widthText), Number(heightText)];
const expected = readFileSync(frames);
const frameBytes = width * height * 2;
const frameCount = expected.length / frameBytes;

// The board's pins, as src/board.rs names them.
const MARK = 2, DC = 16, CS = 17;
const CYCLE_LIMIT = 1e9;
const TOLERANCE = 0.05;


// The panel: a window of columns and rows, filled from left to right and from the top down. Colour inversion and the
// other settings of the start-up change nothing in its memory.
class Panel {
  memory = Buffer.alloc(frameBytes);
  written = 0;
  command = 0;
  args = [];
  window = { x0: 0, x1: width - 1, y0: 0, y1: height - 1 };
  x = 0;
  y = 0;
  high = -1;

  /// Calls `shown` with the memory whenever as many pixels have come as the screen has.
  constructor(shown) {
    this.shown = shown;
  }

  onCommand(byte) {
    this.command = byte;
    this.args = [];
    if (byte === 0x2c) {
      [this.x, this.y, this.high] = [this.window.x0, this.window.y0, -1];
    }
  }

  onData(byte) {
    if (this.command === 0x2c) return this.onPixelByte(byte);
    this.args.push(byte);
    if (this.args.length !== 4) return;
    const [a, b, c, d] = this.args;
    const range = [(a << 8) | b, (c << 8) | d];
    if (this.command === 0x2a) [this.window.x0, this.window.x1] = range;
    if (this.command === 0x2b) [this.window.y0, this.window.y1] = range;
  }

  onPixelByte(byte) {
    if (this.high < 0) {
      this.high = byte;
      return;
    }
    const { x0, x1, y1 } = this.window;
    if (this.x >= width || this.y >= height || this.y > y1) fail(`a pixel at ${this.x}, ${this.y}`);
    const at = (this.y * width + this.x) * 2;
    this.memory[at] = this.high;
    this.memory[at + 1] = byte;
    this.high = -1;
    if (++this.x > x1) [this.x, this.y] = [x0, this.y + 1];
    this.written += 2;
    if (this.written === frameBytes) {
      this.written = 0;
      this.shown(this.memory);
    }
  }
}

if (!(frameCount >= 2)) fail("no expected pictures");

if (program !== undefined) {
  const { ends } = run(program, { frames: frameCount });
  for (let k = 1; k < frameCount; k++) console.log(`frame ${k}: ${ends[k] - ends[k - 1]} cycles`);
  process.exit(0);
}

const phases = run("measure", { phases: frameCount + 2 }).phases;
const [byCore, byDma] = phases.splice(frameCount, 2);
console.log(`a frame sent alone: by DMA ${byDma} cycles, by the processor ${byCore}`);
const blocking = run("blocking", { frames: frameCount }).ends;
const dma = run("dma", { frames: frameCount }).ends;
for (let k = 1; k < frameCount; k++) {
  const [drawn, waiting, overlapped] = [phases[k], blocking[k] - blocking[k - 1], dma[k] - dma[k - 1]];
  const [sum, longer] = [drawn + byCore, Math.max(drawn, byDma)];
  const percent = ((overlapped / longer - 1) * 100).toFixed(1);
  const ways = `blocking ${waiting}; DMA ${overlapped}, ${percent} % above the longer`;
  console.log(`frame ${k}: ${drawn} cycles drawn alone; ${ways}`);
  if (Math.abs(waiting - sum) > TOLERANCE * sum) fail(`a blocking frame should take ${sum} cycles`);
  if (overlapped > (1 + TOLERANCE) * longer) fail(`a frame with DMA should take ${longer} cycles`);
}

/// Runs a program until it has shown a number of frames, or held the pin for a number of phases.
function run(name, until) {
  const chip = new RP2040();
  load(chip, readFileSync(`${folder}/${name}`));
  // There is no boot ROM: start at the vector table behind the 256 bytes it would have run.
  chip.core.VTOR = 0x10000100;
  chip.core.reset();
  mendOverflow(chip.core);

  const ends = [], phases = [];
  const panel = new Panel((picture) => {
    if (!until.frames) return;
    check(name, ends.length, picture);
    ends.push(chip.core.cycles);
  });

  const spi = chip.spi[0];
  // When the byte on the wire will be complete, and, while its successor starts, when it was.
  let due = Infinity, done;
  spi.onTransmit = (byte) => {
    if (chip.gpio[CS].value !== GPIOPinState.Low) fail(`${name}: a byte for nobody`);
    chip.gpio[DC].value === GPIOPinState.High ? panel.onData(byte) : panel.onCommand(byte);
    due = (done ?? chip.core.cycles) + (spi.dataBits * chip.clkSys) / spi.clockFrequency;
  };

  let start = 0;
  chip.gpio[MARK].addListener((state, before) => {
    if (state === GPIOPinState.High) start = chip.core.cycles;
    else if (before === GPIOPinState.High) phases.push(chip.core.cycles - start);
  });

  while (until.frames ? ends.length < until.frames : phases.length < until.phases) {
    if (chip.core.cycles > CYCLE_LIMIT) fail(`${name}: stuck at ${chip.core.PC.toString(16)}`);
    const before = chip.core.cycles;
    chip.core.executeInstruction();
    chip.clock.tick((chip.core.cycles - before) * 8); // 125 MHz
    while (chip.core.cycles >= due) {
      [done, due] = [due, Infinity];
      spi.completeTransmit(0);
      done = undefined;
    }
  }
  console.log(`${name}: SPI at ${spi.clockFrequency / 1e6} MHz, core at ${chip.clkSys / 1e6} MHz`);
  return { ends, phases };
}

/// Mends the flag V of ADCS and SBCS. rp2040js adds the carry to the second operand before it looks at signs, so that
/// 0x7fffffff and a carry look like the least number; comparisons with the greatest number of 64 bits go wrong then.
function mendOverflow(core) {
  const [ADCS, SBCS] = [0x4140, 0x4180];
  const isNow = (opcode) => (core.rp2040.readUint16(core.PC - 2) & 0xffc0) === opcode;
  const { addUpdateFlags, substractUpdateFlags } = core;
  core.addUpdateFlags = (a, b) => {
    const carried = b === 0x80000000 && core.C && isNow(ADCS);
    const sum = addUpdateFlags.call(core, a, b);
    if (carried) core.V = a < 0x80000000;
    return sum;
  };
  core.substractUpdateFlags = (a, b) => {
    const borrowed = b === 0x80000000 && !core.C && isNow(SBCS);
    const difference = substractUpdateFlags.call(core, a, b);
    if (borrowed) core.V = a >= 0x80000000;
    return difference;
  };
}

/// Copies what an ELF file wants in flash.
function load(chip, file) {
  const at = new DataView(file.buffer, file.byteOffset, file.length);
  const [table, size, count] = [at.getUint32(28, true), at.getUint16(42, true), at.getUint16(44, true)];
  for (let i = 0; i < count; i++) {
    const header = table + i * size;
    const [type, offset, , address, length] = [0, 4, 8, 12, 16].map((o) => at.getUint32(header + o, true));
    if (type === 1 && length > 0) chip.flash.set(file.subarray(offset, offset + length), address - 0x10000000);
  }
}

function check(name, frame, picture) {
  const want = expected.subarray(frame * frameBytes, (frame + 1) * frameBytes);
  let different = 0;
  for (let i = 0; i < frameBytes; i += 2) {
    if (picture.readUInt16BE(i) !== want.readUInt16BE(i)) different++;
  }
  writePpm(picture);
  if (different > 0) fail(`${name}, frame ${frame}: ${different} pixels differ`);
  console.log(`${name}, frame ${frame}: all ${frameBytes / 2} pixels equal`);
}

function writePpm(picture) {
  const rgb = Buffer.alloc(width * height * 3);
  for (let i = 0; i < width * height; i++) {
    const pixel = picture.readUInt16BE(i * 2);
    const [r, g, b] = [pixel >> 11, (pixel >> 5) & 63, pixel & 31];
    rgb.set([(r << 3) | (r >> 2), (g << 2) | (g >> 4), (b << 3) | (b >> 2)], i * 3);
  }
  writeFileSync(out, Buffer.concat([Buffer.from(`P6 ${width} ${height} 255\n`), rgb]));
}

function fail(why) {
  console.error(why);
  process.exit(1);
}

// Runs the firmware on an emulated RP2040 with a model of an ST7789 panel on its SPI bus.
//
//     node emulate.mjs firmware.elf frames.raw width height out.ppm
//
// frames.raw holds the expected pictures, one after the other, as big-endian RGB565. Every frame
// that arrives is compared with its own; the last one is written to out.ppm. Prints the cycles of
// each frame, split by the firmware's pins into rendering and sending.
import { readFileSync, writeFileSync } from "node:fs";
import { RP2040, GPIOPinState } from "rp2040js";

const [elf, frames, widthText, heightText, out] = process.argv.slice(2);
const [width, height] = [Number(widthText), Number(heightText)];
const expected = readFileSync(frames);
const frameBytes = width * height * 2;

// The board's pins, as src/main.rs names them.
const SENDING = 2, IN_FRAME = 3, DC = 16, CS = 17;
const CYCLE_LIMIT = 4e9;

const chip = new RP2040();
load(readFileSync(elf));
// There is no boot ROM: start at the vector table behind the 256 bytes it would have run.
chip.core.VTOR = 0x10000100;
chip.core.reset();

/// Copies what an ELF file wants in flash.
function load(file) {
  const at = new DataView(file.buffer, file.byteOffset, file.length);
  const [table, size, count] = [at.getUint32(28, true), at.getUint16(42, true), at.getUint16(44, true)];
  for (let i = 0; i < count; i++) {
    const header = table + i * size;
    const [type, offset, , address, length] = [0, 4, 8, 12, 16].map((o) => at.getUint32(header + o, true));
    if (type === 1 && length > 0) chip.flash.set(file.subarray(offset, offset + length), address - 0x10000000);
  }
}

// The panel: a window of columns and rows, filled from left to right and from the top down.
// Colour inversion and the other settings of the start-up change nothing in its memory.
const panel = {
  memory: Buffer.alloc(frameBytes),
  written: 0,
  command: 0,
  args: [],
  window: { x0: 0, x1: width - 1, y0: 0, y1: height - 1 },
  x: 0,
  y: 0,
  high: -1,

  onCommand(byte) {
    this.command = byte;
    this.args = [];
    if (byte === 0x2c) {
      [this.x, this.y, this.high] = [this.window.x0, this.window.y0, -1];
    }
  },
  onData(byte) {
    if (this.command === 0x2c) return this.onPixelByte(byte);
    this.args.push(byte);
    if (this.args.length !== 4) return;
    const [a, b, c, d] = this.args;
    const range = [(a << 8) | b, (c << 8) | d];
    if (this.command === 0x2a) [this.window.x0, this.window.x1] = range;
    if (this.command === 0x2b) [this.window.y0, this.window.y1] = range;
  },
  onPixelByte(byte) {
    if (this.high < 0) {
      this.high = byte;
      return;
    }
    const { x0, x1, y0, y1 } = this.window;
    if (this.x >= width || this.y >= height || this.y > y1) fail(`a pixel at ${this.x}, ${this.y}`);
    const at = (this.y * width + this.x) * 2;
    this.memory[at] = this.high;
    this.memory[at + 1] = byte;
    this.written += 2;
    this.high = -1;
    if (++this.x > x1) [this.x, this.y] = [x0, this.y + 1];
  },
};

// A byte takes its time on the wire: it is complete when the core's cycles have passed.
const spi = chip.spi[0];
let due = Infinity;
spi.onTransmit = (byte) => {
  if (chip.gpio[CS].value === GPIOPinState.Low) {
    chip.gpio[DC].value === GPIOPinState.High ? panel.onData(byte) : panel.onCommand(byte);
  }
  due = chip.core.cycles + (spi.dataBits * chip.clkSys) / spi.clockFrequency;
};

let frame = 0, frameStart = 0, sendStart = 0, sending = 0;
chip.gpio[SENDING].addListener((state, before) => {
  if (state === GPIOPinState.High) sendStart = chip.core.cycles;
  else if (before === GPIOPinState.High) sending += chip.core.cycles - sendStart;
});
chip.gpio[IN_FRAME].addListener((state, before) => {
  if (state === GPIOPinState.High) {
    [frameStart, sending, panel.written] = [chip.core.cycles, 0, 0];
  } else if (before === GPIOPinState.High) {
    const total = chip.core.cycles - frameStart;
    check();
    console.log(`frame ${frame}: ${total} cycles = ${total - sending} rendering + ${sending} sending`);
    frame++;
  }
});

function check() {
  if (panel.written !== frameBytes) fail(`frame ${frame}: ${panel.written} bytes, not ${frameBytes}`);
  const want = expected.subarray(frame * frameBytes, (frame + 1) * frameBytes);
  let different = 0;
  for (let i = 0; i < frameBytes; i += 2) {
    if (panel.memory.readUInt16BE(i) !== want.readUInt16BE(i)) different++;
  }
  writePpm();
  if (different > 0) fail(`frame ${frame}: ${different} pixels differ`);
  console.log(`frame ${frame}: all ${frameBytes / 2} pixels equal`);
}

function writePpm() {
  const rgb = Buffer.alloc(width * height * 3);
  for (let i = 0; i < width * height; i++) {
    const pixel = panel.memory.readUInt16BE(i * 2);
    const [r, g, b] = [pixel >> 11, (pixel >> 5) & 63, pixel & 31];
    rgb.set([(r << 3) | (r >> 2), (g << 2) | (g >> 4), (b << 3) | (b >> 2)], i * 3);
  }
  writeFileSync(out, Buffer.concat([Buffer.from(`P6 ${width} ${height} 255\n`), rgb]));
}

function fail(why) {
  console.error(why);
  process.exit(1);
}

const frameCount = expected.length / frameBytes;
if (!(frameCount >= 1)) fail("no expected picture");
while (frame < frameCount) {
  if (chip.core.cycles > CYCLE_LIMIT) fail(`stuck at ${chip.core.PC.toString(16)}`);
  const before = chip.core.cycles;
  chip.core.executeInstruction();
  chip.clock.tick((chip.core.cycles - before) * 8); // 125 MHz
  if (chip.core.cycles >= due) {
    due = Infinity;
    spi.completeTransmit(0);
  }
}
console.log(`SPI at ${spi.clockFrequency / 1e6} MHz, core at ${chip.clkSys / 1e6} MHz`);

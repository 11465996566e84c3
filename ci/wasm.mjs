// Runs a Wasm build of an example under Node: node ci/wasm.mjs file.wasm
// The only thing it needs from outside is a line printer.
import { readFileSync } from "node:fs";

const host = {
  print(text, length) {
    const bytes = new Uint8Array(instance.exports.memory.buffer, text, length);
    console.log(new TextDecoder().decode(bytes));
  },
};
const { instance } = await WebAssembly.instantiate(readFileSync(process.argv[2]), { host });
process.exitCode = instance.exports.main(0, 0);

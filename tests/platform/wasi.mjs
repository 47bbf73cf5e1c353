// wasi.mjs PROGRAM FOLDER: runs a WASI program by node, which sees FOLDER as /files.
import { readFileSync } from 'node:fs';
import { WASI } from 'node:wasi';

const [program, folder] = process.argv.slice(2);
const wasi = new WASI({ version: 'preview1', args: [program, 'baseline', '/files'], preopens: { '/files': folder } });
const { instance } = await WebAssembly.instantiate(readFileSync(program), wasi.getImportObject());
process.exitCode = wasi.start(instance);

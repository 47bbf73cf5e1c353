// What the library writes piece by piece, as bytes.
import { constants as C } from './layout.mjs';
import { MpmError } from './machine.mjs';

export function pieces(handle, name, values, fields) {
  const { machine } = handle;
  if (!machine.raw[name])
    throw new MpmError(C.MPM_E_UNSUPPORTED, 'MPM_E_UNSUPPORTED', `this version of the library has no ${name}()`);
  const parts = [];
  let bytes = 0;
  handle.arguments((a) => {
    const keep = (data) => {
      parts.push(data.slice());
      bytes += data.length;
    };
    try {
      handle.functions.set('write', 'mpm_write_fn', keep, (call, user) => {
        handle.call(name, [...values, call, user, ...(fields ? [fields.length, a.texts(fields)] : [])]);
      });
    } finally {
      handle.functions.set('write', 'mpm_write_fn', null, () => {});
    }
  });
  const out = new Uint8Array(bytes);
  let at = 0;
  for (const part of parts) {
    out.set(part, at);
    at += part.length;
  }
  return out;
}

// Contexts: the services of the library, and what is made with them.
import { Functions } from './callbacks.mjs';
import { Grid } from './grid.mjs';
import { Handle } from './handle.mjs';
import { MpmError } from './machine.mjs';
import { Material } from './material.mjs';
import { Obstacle } from './obstacle.mjs';
import { Particles } from './particles.mjs';
import { Stepper } from './stepper.mjs';
import { Surface } from './surface.mjs';

const SENTENCE = 1024; // bytes for why a context was not made

export class Context extends Handle {
  constructor(machine, desc = {}) {
    const { log, ...rest } = desc;
    const functions = new Functions(machine);
    const at = machine.arguments((a) => {
      const to = a.struct('mpm_context_desc', rest);
      const text = a.bytes(SENTENCE);
      a.put(to, 'mpm_context_desc', 'error_text', text);
      a.put(to, 'mpm_context_desc', 'error_bytes', SENTENCE);
      functions.set('log', 'mpm_context_desc_log_fn', log, (call, user) => {
        a.put(to, 'mpm_context_desc', 'log', call);
        a.put(to, 'mpm_context_desc', 'log_user', user);
      });
      const out = a.room('pointer');
      const status = machine.raw.mpm_context_create(to, out);
      if (status) {
        machine.dropLogged();
        throw new MpmError(status, machine.text(machine.raw.mpm_status_name(status)), machine.text(text));
      }
      machine.contexts++;
      return machine.read(out, 'pointer');
    });
    super(machine, null, 'context', at, [], functions);
    try {
      machine.tellLogged();
    } catch (error) {
      this.dispose();
      throw error;
    }
  }
  memory() {
    const [bytes, peak_bytes] = this.ask('mpm_context_memory', [], ['i64', 'i64']);
    return { bytes, peak_bytes };
  }
  lastError() {
    return this.machine.text(this.machine.raw.mpm_last_error(this.at));
  }
  grid(desc) {
    return new Grid(this, desc);
  }
  material(model, params) {
    return Material.model(this, model, params);
  }
  law(desc) {
    return Material.law(this, desc);
  }
  particles(grid, material) {
    return new Particles(this, grid, material);
  }
  obstacle(desc) {
    return new Obstacle(this, desc);
  }
  surface(grid, desc) {
    return new Surface(this, grid, desc);
  }
  stepper(grid, desc) {
    return new Stepper(this, grid, desc);
  }
}

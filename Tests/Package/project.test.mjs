// The library in git by the C interface, as `npm run project` plays it.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import { headerFile, loadLibrary, readHeader } from '../../scripts/lib/c_interface.mjs';
import { inRepository } from '../../scripts/lib/process.mjs';
import { runtimeLibrary } from '../../scripts/pack/dependency.mjs';
import { playStroke } from '../../scripts/project/play_stroke.mjs';

const plugins = (...parts) => inRepository('Packages', 'com.haptoflow.runtime', 'Runtime', ...parts);
const files = {
  library: plugins('Plugins', 'Linux', 'x64', 'libaudioplugin_haptoflow.so'),
  runtime: runtimeLibrary('linux-x64'),
  model: plugins('Models', 'default.haptoflow'),
};
const elsewhere = { skip: process.platform === 'linux' && process.arch === 'x64' ? false : 'its library is that of Linux x64' };

test('the header\'s structs and functions are read with arrays, nested structs and handles', () => {
  const { structs, functions } = readHeader(`
#define N 4
typedef uint64_t haptoflow_voice;
typedef struct haptoflow_inner { uint32_t struct_size; } haptoflow_inner;
typedef struct haptoflow_outer {
    /* A comment; with a semicolon. */
    haptoflow_inner inner;
    float weights[N];
    const char* name;
} haptoflow_outer;
HAPTOFLOW_API haptoflow_status haptoflow_voice_create(const haptoflow_outer* options,
                                                      haptoflow_voice* voice);
HAPTOFLOW_API const char* haptoflow_version(void);
`);
  assert.deepEqual(structs.at(-1).fields, [
    { type: 'haptoflow_inner', name: 'inner', length: null }, { type: 'float', name: 'weights', length: 4 }, { type: 'const char*', name: 'name', length: null },
  ]);
  assert.deepEqual(functions, [
    { name: 'haptoflow_voice_create', returned: 'haptoflow_status', parameters: ['const haptoflow_outer*', 'haptoflow_voice*'] },
    { name: 'haptoflow_version', returned: 'const char*', parameters: [] },
  ]);
});

test('the library in git has the layouts of the header', elsewhere, () => assert.deepEqual(loadLibrary(files.library).disagreeing, []));

test('a struct with one field more than the library knows is named', elsewhere, () => {
  const text = readFileSync(headerFile, 'utf8').replace('typedef struct haptoflow_tier_times {', 'typedef struct haptoflow_tier_times {\n    double added;');
  assert.deepEqual(loadLibrary(files.library, readHeader(text)).disagreeing, ['haptoflow_tier_times']);
});

test('the library in git plays a stroke, by its network, and is silent after it', elsewhere, async () => {
  const played = await playStroke(files);
  assert.equal(played.version, JSON.parse(readFileSync(inRepository('package.json'), 'utf8')).version);
  assert.ok(played.inferences > 0, 'segments');
  assert.ok(played.levelMps2 > 0.05 && played.levelMps2 < 5, `${played.levelMps2} m/s²`);
  assert.equal(played.restPeak, 0);
});

test('a model that is no model is named with its status', elsewhere, async () => {
  await assert.rejects(playStroke({ ...files, model: headerFile }), /NOT_A_MODEL/);
});

import assert from 'node:assert/strict';
import { existsSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import { callerFolder, inRepository } from '../../scripts/lib/process.mjs';
import { bringRecordings, clusterOptions, trainingWords } from '../../scripts/lib/training_words.mjs';
import { startHub } from './support/hub_server.mjs';

test('the options of --cluster are taken out, and the others go to train-tiers', () => {
  const options = clusterOptions(['--cluster', '--textures=0,38', '--lanes', '1', '--into', 'data']);
  assert.deepEqual(options, { textures: '0,38', into: path.resolve(callerFolder(), 'data'), further: ['--lanes', '1'] });
  assert.deepEqual(clusterOptions(['--cluster']), { textures: null, into: inRepository('out', 'cluster-haptic-texture'), further: [] });
});

test('words of --cluster that cannot be meant are refused', () => {
  for (const words of [['--textures'], ['--textures', '--into', 'x'], ['--textures', '0;38'], ['--into='], ['--recordings', 'x'], ['--recordings=x'], ['train-tiers']]) {
    assert.throws(() => clusterOptions(['--cluster', ...words]), { exitCode: 2 }, words.join(' '));
  }
});

test('the training has the data set\'s configuration, recordings and labels, and a place for the model, unless others are named', () => {
  const brought = { into: 'data', labels: 'data/labels.toml' };
  const out = inRepository('out', 'train', 'cluster');
  assert.deepEqual(trainingWords({ ...brought, further: ['--lanes', '1'] }), [
    'train-tiers', '--recordings', 'data', '--configs', inRepository('Training', 'configs', 'cluster'), '--labels', 'data/labels.toml', '--out', out,
    '--export', path.join(out, 'cluster.haptoflow'), '--lanes', '1',
  ]);
  const further = ['--out=mine', '--labels', 'own.toml', '--export', 'm.haptoflow', '--configs', 'c'];
  assert.deepEqual(trainingWords({ ...brought, further }), ['train-tiers', '--recordings', 'data', ...further]);
});

/** The data set with two recordings of each texture, with texts in place of tables. */
async function withHub(body) {
  const files = { 'texture_list.xlsx': Buffer.from('list'), 'README.md': Buffer.from('page') };
  for (const kind of ['accel', 'force', 'position', 'audio']) {
    for (const id of [0, 38, 49]) {
      for (const repeat of [0, 1]) files[`sensor_data/${kind}/${id}/${id}_0_40_500_${repeat}.parquet`] = Buffer.alloc(kind === 'accel' ? 30_000 : 3000, `${kind} ${id} ${repeat} `);
    }
  }
  const hub = await startHub({ repositories: [{ type: 'dataset', name: 'tamago117/cluster-haptic-texture-dataset', files, licence: 'cc-by-4.0' }], pageSize: 1 });
  const into = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-cluster-'));
  const said = [];
  const asked = [];
  const bring = () => bringRecordings({ textures: '0,38', into }, async (words) => {
    asked.push(words);
    return 'a warning\n0\twood\n38\tstone\n';
  }, { hubUrl: hub.address, say: (line) => said.push(line), wait: async () => {} });
  try {
    await body({ hub, into, bring, said, asked });
  } finally {
    await hub.close();
    rmSync(into, { recursive: true, force: true });
  }
}

test('acceleration, force and position of the chosen textures are brought, and nothing else', () => withHub(async ({ hub, into, bring, said, asked }) => {
  const labels = path.join(into, 'labels.toml');
  assert.deepEqual(await bring(), { labels, files: 12, bytes: 4 * 36_000, newFiles: 12 });
  assert.deepEqual(asked, [['labels', into, '--out', labels, '--textures', '0,38']]);
  assert.ok(existsSync(path.join(into, 'sensor_data', 'force', '38', '38_0_40_500_1.parquet')));
  assert.ok(!existsSync(path.join(into, 'sensor_data', 'audio')) && !existsSync(path.join(into, 'sensor_data', 'accel', '49')));
  assert.match(said.join('\n'), /licence cc-by-4\.0[^]*wood \(0\), stone \(38\)[^]*12 files, 0\.1 MB/);
  assert.ok(hub.requests.length > 0);
}));

test('after a refusal and a cut connection, the next run brings only what is missing', () => withHub(async ({ hub, into, bring }) => {
  const refused = 'sensor_data/force/0/0_0_40_500_0.parquet';
  hub.fail(refused, { status: 404 });
  await assert.rejects(bring(), /no "sensor_data\/force\/0\/0_0_40_500_0\.parquet"/);
  assert.ok(!existsSync(path.join(into, refused)));
  const damaged = path.join(into, 'sensor_data', 'accel', '0', '0_0_40_500_0.parquet');
  writeFileSync(damaged, 'short');
  const { newFiles } = await bring();
  assert.ok(newFiles >= 2 && newFiles < 12, `${newFiles} of 12`);
  assert.equal((await bring()).newFiles, 0);
}));

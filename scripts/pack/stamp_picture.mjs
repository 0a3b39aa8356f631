// Stamps PNG files with the SHA-256 of the shipped model: node scripts/pack/stamp_picture.mjs FILE...
import { readFileSync, writeFileSync } from 'node:fs';
import { sha256Of, shippedModel, stampedPicture } from '../lib/model_stamp.mjs';
import { CommandError, runMain } from '../lib/process.mjs';

await runMain('stamp_picture', async (files) => {
  if (files.length === 0) throw new CommandError('which PNG files?', 2);
  for (const file of files) writeFileSync(file, stampedPicture(readFileSync(file), sha256Of(shippedModel)));
});

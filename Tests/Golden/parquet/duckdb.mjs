// Writes Parquet files with DuckDB: node duckdb.mjs STATEMENTS.sql, in a folder where @duckdb/node-api is installed.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';

const { DuckDBInstance } = createRequire(path.join(process.cwd(), 'package.json'))('@duckdb/node-api');
const connection = await (await DuckDBInstance.create(':memory:')).connect();
for (const statement of readFileSync(process.argv[2], 'utf8').split(';').filter((each) => each.trim() !== '')) await connection.run(statement);

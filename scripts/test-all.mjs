// test:all: runs every test, the long form of `test`: all sanitizers, libc++ and the other platforms, too
process.argv.splice(2, 0, '--all');
await import('./test.mjs');

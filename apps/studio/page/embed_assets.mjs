// node embed_assets.mjs DIST NAME: writes NAME.S, which holds the bytes of every file below DIST, and NAME.cpp, the table
// of them that page_assets.h declares. The assembler takes the bytes as they are, so that compiling is a matter of
// milliseconds.

import { createHash } from 'node:crypto';
import { readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { basename, extname, join, relative, resolve } from 'node:path';

const mimeTypes = {
    '.html': 'text/html; charset=utf-8',
    '.json': 'application/json',
    '.js': 'text/javascript; charset=utf-8',
    '.css': 'text/css; charset=utf-8',
    '.svg': 'image/svg+xml',
    '.png': 'image/png',
    '.woff2': 'font/woff2',
};

function filesBelow(folder) {
    return readdirSync(folder, { withFileTypes: true }).flatMap((entry) => {
        const path = join(folder, entry.name);
        return entry.isDirectory() ? filesBelow(path) : [path];
    });
}

const [dist, name] = process.argv.slice(2);
if (!dist || !name) {
    console.error('usage: node embed_assets.mjs DIST NAME');
    process.exit(2);
}
const files = filesBelow(resolve(dist)).map((file) => {
    const mime = mimeTypes[extname(file)];
    if (!mime) throw new Error(`${file}: no known kind of file; name its MIME type in embed_assets.mjs`);
    return { file, mime, path: relative(resolve(dist), file).replaceAll('\\', '/') };
});
files.sort((a, b) => (a.path < b.path ? -1 : 1));
if (!files.some(({ path }) => path === 'index.html')) throw new Error(`${dist} has no index.html`);

const symbol = (i) => `plisse_page_asset_${i}`;
const bytes = files.map(({ file }) => readFileSync(file));
// The hash makes the text change with the bytes, for whatever compares texts to know whether to compile.
const blocks = files.map(({ file }, i) => `// ${createHash('sha256').update(bytes[i]).digest('hex')}
    .global ${symbol(i)}
    .balign 16
${symbol(i)}:
    .incbin ${JSON.stringify(file)}
`);
writeFileSync(`${name}.S`, `    .section .rodata
${blocks.join('')}    .section .note.GNU-stack,"",%progbits
`);

const declared = files.map((_, i) => `extern const unsigned char ${symbol(i)}[];`);
const rows = files.map(({ path, mime }, i) =>
    `    {${JSON.stringify(path)}, ${JSON.stringify(mime)}, {${symbol(i)}, ${bytes[i].length}}},`);
writeFileSync(`${name}.cpp`, `// Made by embed_assets.mjs for ${basename(name)}.
#include "page_assets.h"

extern "C" {
${declared.join('\n')}
}

namespace plisse::studio {

std::span<const Asset> page_assets() {
    static const Asset assets[] = {
${rows.map((row) => `    ${row}`).join('\n')}
    };
    return assets;
}

} // namespace plisse::studio
`);

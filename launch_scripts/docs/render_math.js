// Reads a JSON list of {display, tex} from stdin and writes the list of their HTML. A formula that is wrong ends it with 1.
'use strict';
const fs = require('fs');
const katex = require('katex');

const rendered = JSON.parse(fs.readFileSync(0, 'utf8')).map(({display, tex}) => {
  try {
    return katex.renderToString(tex, {displayMode: display, throwOnError: true, strict: 'error'});
  } catch (error) {
    process.stderr.write(`formula '${tex.trim()}': ${error.message}\n`);
    process.exit(1);
  }
});
process.stdout.write(JSON.stringify(rendered));

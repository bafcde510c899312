// Asks the site's own search, as its pages do: a query a line from stdin; out go a line each, the query and the first three pages.
// Usage: node search.js SITE
const fs = require('fs'), vm = require('vm');
const site = process.argv[2], workers = `${site}/assets/javascripts/workers`;
const index = JSON.parse(fs.readFileSync(`${site}/search/search_index.json`));
const handlers = [], waiting = [];
const worker = {
  console, setTimeout, URL, performance, importScripts() {}, location: {href: 'http://localhost/'},
  addEventListener: (kind, handler) => kind === 'message' && handlers.push(handler),
  postMessage: message => waiting.shift()(message),
};
worker.self = worker.globalThis = worker;
vm.runInContext(fs.readFileSync(`${workers}/${fs.readdirSync(workers).find(file => file.endsWith('.js'))}`, 'utf8'), vm.createContext(worker));
const send = data => new Promise(resolve => { waiting.push(resolve); handlers.forEach(handler => handler({data})); });

(async () => {
  await send({type: 0, data: {config: index.config, docs: index.docs, options: {suggest: false}}});  // set up
  for (const query of fs.readFileSync(0, 'utf8').split('\n').filter(Boolean)) {
    const found = await send({type: 2, data: query});
    console.log([query, ...found.data.items.slice(0, 3).map(page => page[0].location.split('#')[0])].join('\t'));
  }
})();

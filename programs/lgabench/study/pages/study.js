'use strict';
// The pages of a study. The server knows where a session is; this script shows it, and says what happens.

const random = () => [...crypto.getRandomValues(new Uint8Array(16))].map(b => b.toString(16).padStart(2, '0')).join('');
const page = random();  // of this load of the page: the server takes events of the last one alone
const id = (location.pathname.match(/^\/p\/([0-9a-f]{32})$/) || [])[1];
const main = document.getElementById('main'), trouble = document.getElementById('trouble');
const wait = ms => new Promise(done => setTimeout(done, ms));
const troubleAfter = 5000, idleAfter = 30000;  // ms; the server's limits too
let about;                                     // /study.json

// --- elements; text is only ever set as text ---

function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else if (value === true) element.setAttribute(name, '');
    else if (value !== false) element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
}

const button = (text, onclick, kind = 'main') => make('button', {type: 'button', class: kind, onclick}, text);

function show(title, ...content) {
  const head = make('h1', {tabindex: '-1'}, title);
  main.replaceChildren(head, ...content);
  window.scrollTo(0, 0);
  head.focus({preventScroll: true});
}

const words = (...content) => make('div', {class: 'words'}, ...content);
const paragraphs = (...texts) => texts.map(text => make('p', {}, text));

function say(text) {
  trouble.hidden = !text;
  trouble.textContent = text;
}

function stop(title, ...texts) {
  trial = null;
  say('');
  show(title, words(...paragraphs(...texts)));
}

// --- the server ---

async function ask(path, body) {
  const timeout = new AbortController(), timer = setTimeout(() => timeout.abort(), 15000);
  try {
    const options = {cache: 'no-store', credentials: 'omit', signal: timeout.signal};
    if (body !== undefined)
      Object.assign(options, {method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify(body)});
    const answer = await fetch(path, options);
    return {status: answer.status, json: await answer.json()};
  } finally {
    clearTimeout(timer);
  }
}

// Until there is an answer. What was sent twice counts once: it has a key.
async function deliver(path, body) {
  const begun = performance.now();
  for (let pause = 250;; pause = Math.min(2 * pause, 4000)) {
    const late = setTimeout(() => say('The connection to the study is lost. Trying again…'),
                            Math.max(0, troubleAfter - (performance.now() - begun)));
    try {
      const answer = await ask(path, body);
      if (answer.status < 500) return say(''), answer;
    } catch (error) {  // no connection, or a broken one
    } finally {
      clearTimeout(late);
    }
    if (performance.now() - begun > troubleAfter) say('The connection to the study is lost. Trying again…');
    await wait(pause);
  }
}

// --- events: at once, in order, each until it is acknowledged ---

const waiting = [];
let sending = false, longest = 0;

function post(kind, more = {}) {
  waiting.push({key: random(), page, kind, page_ms: performance.now(), ...more});
  if (!sending) send();
}

async function send() {
  sending = true;
  while (waiting.length) {
    const events = waiting.slice(0, 50);
    const answer = await deliver(`/p/${id}/events`, {events});
    if (answer.status === 409)
      return stop('This session is open in another window', 'You can close this one.');
    if (answer.status === 404) return gone();
    if (answer.status !== 200)
      return stop('Something went wrong', `Please tell ${about.contact}. What you did so far is kept.`, answer.json.error || '');
    longest = Math.max(longest, performance.now() - events[0].page_ms);
    waiting.splice(0, events.length);
    if (answer.json.step) enter(answer.json);
  }
  sending = false;
}

const longestWait = () => Math.max(longest, waiting.length ? performance.now() - waiting[0].page_ms : 0);

// --- consent, withdrawal ---

function consentText(text) {
  return text.split(/\n\s*\n/).filter(part => part.trim()).map(
    part => part.startsWith('# ') ? make('h2', {}, part.slice(2).trim()) : make('p', {}, part.trim()));
}

function consent() {
  const key = random();
  const agree = button('I agree and begin', async () => {
    agree.disabled = true;
    const invitation = new URLSearchParams(location.search).get('invitation');
    const answer = await deliver('/begin', {key, consent: about.consent_sha256, ...(invitation && {invitation})});
    if (answer.status === 200) location.replace('/p/' + answer.json.id);
    else stop('Something went wrong', `Please reload the page, or tell ${about.contact}.`, answer.json.error || '');
  });
  const decline = button('I do not agree', () => stop('Thank you', 'Nothing was stored. You can close this page.'), '');
  show(about.title, words(...consentText(about.consent), make('div', {class: 'buttons'}, agree, decline)));
}

function withdraw() {
  const code = make('input', {type: 'text', id: 'code', autocomplete: 'off', spellcheck: 'false'});
  const said = make('p', {role: 'status'});
  const go = button('Delete all that is stored about me', async () => {
    if (!code.value.trim()) return code.focus();
    const answer = await deliver('/withdraw', {code: code.value});
    if (answer.status === 200)
      stop('You have withdrawn', `What was stored under this code is deleted. If you have a question: ${about.contact}`);
    else said.textContent = 'There is nothing under this code. It has 16 letters and digits.';
  });
  show('Withdraw from the study',
       words(make('p', {}, make('label', {for: 'code'}, 'Your withdrawal code')), code, said, make('div', {class: 'buttons'}, go)));
}

const gone = () => stop('There is no such session', 'It was withdrawn, or the address is not complete.');

// --- familiarisation ---

const featureNames = {object_types: 'Object types', textures: 'Colors'};

function picture(feature, name) {
  const {names, tile, step, across} = about.pictures[feature], at = names.indexOf(name), scale = (feature === 'pairs' ? 144 : 72) / tile;
  const element = make('span', {class: 'picture ' + feature, 'aria-hidden': 'true'});
  const width = (across * step - (step - tile)) * scale;
  element.style.backgroundSize = `${width}px auto`;
  element.style.backgroundPosition = `${-(at % across) * step * scale}px ${-Math.floor(at / across) * step * scale}px`;
  return element;
}

function gallery(feature, names) {
  return make('section', {}, make('h2', {}, `${featureNames[feature]} (${names.length})`),
              make('ul', {class: 'tiles'},
                   ...names.map(name => make('li', {}, make('span', {class: 'tile'}, picture(feature, name), name)))));
}

function once(text, kind) {
  const go = button(text, () => {
    go.disabled = true;
    post(kind);
  });
  return make('div', {class: 'buttons'}, go);
}

function familiarisation(state) {
  const code = make('p', {class: 'note'}, 'You may stop at any time by closing this page. With your withdrawal code, ',
                    make('code', {}, state.withdrawal_code), ', you can have deleted what is stored. You will see it again at the end.');
  if (state.of_pairs)
    return show('Which objects does a command mean?', words(...paragraphs(
      'A robot is given commands, such as “pick up the red bowl”. For each command you see some objects, each with its name and color. Say of each whether the command could mean it.',
      'Judge each object by itself. There are no right answers where people differ. First comes one command for practice.', ...instruction()), code),
                once('Continue', 'familiarised'));
  show('What the robot can see',
       words(...paragraphs(
         'You are helping to teach a robot which properties of objects matter for a task. The robot is given a command, such as “pick up the red bowl”.',
         'For each command you say which objects it could mean: which object types, and which colors. Any type can have any color; an object has exactly one type and one color.',
         'Here is everything there is. Take your time to look at it; the lists will be at hand later.'),
         code),
       gallery('object_types', state.object_types), gallery('textures', state.textures), once('Continue', 'familiarised'));
}

function example(state) {
  show('An example',
       words(make('p', {class: 'command'}, `“${state.command}”`),
             ...paragraphs('Geometric shapes are these object types, and these colors have polka dots. An object that fits has one of these types and one of these colors:')),
       gallery('object_types', state.answer.object_types), gallery('textures', state.answer.textures),
       words(...paragraphs('Next come two commands for practice, which are not timed. Then it begins.', ...instruction())),
       once('Continue', 'example_seen'));
}

// --- a trial ---

const instruction = () => about.instruction ? [about.instruction] : [];
let trial = null;  // while a command is shown: {lastInput, idle, away}

function ready({condition, practice, number, of, first_of_part, interrupted, proposed_by_model, of_pairs}) {
  const filled = condition === 'lga_hill';
  const texts = of_pairs ? ['Could the command mean the object? Say so of each.', ...instruction()] : filled
    ? [proposed_by_model ? 'A large language model’s answer is filled in. Change it as you like, or submit it as it is.'
      : 'For practice, an answer that we made up is filled in. Change it as you like, or submit it as it is. In the study, a large language model’s answers will be filled in.']
    : ['The lists are empty at first: choose all object types and all colors that the command could mean.'];
  if (!practice && !of_pairs) texts.push(...instruction(), 'Time runs from when the command appears until you submit. Please stay on this page until then.');
  const notes = interrupted ? [make('p', {class: 'note'}, practice || of_pairs
    ? 'The last command was interrupted, so it is shown again.' : 'The last command was interrupted. It does not count; the study continues with the next one.')] : [];
  if (first_of_part && !of_pairs) notes.push(make('p', {class: 'note'}, filled ? 'In this part the answers are filled in.' : 'In this part the lists begin empty.'));
  show(practice ? of_pairs ? 'Practice' : `Practice ${number} of 2` : `Command ${number} of ${of}`, words(...notes, ...paragraphs(...texts), once('Start', 'start')));
}

// `edited(values, on)` says what was chosen, or unchosen.
function list(feature, names, chosen, edited, changed) {
  const title = featureNames[feature], boxes = [];
  const search = make('input', {type: 'search', placeholder: 'Search', 'aria-label': `Search ${title.toLowerCase()}`,
                                autocomplete: 'off', spellcheck: 'false'});
  const count = make('p', {class: 'count soft'});
  const all = button('', () => choose(shown(), true), ''), none = button('', () => choose(shown(), false), '');
  const only = make('button', {type: 'button', 'aria-pressed': 'false', onclick: () => {
    only.setAttribute('aria-pressed', only.getAttribute('aria-pressed') === 'false');
    filter();
  }}, 'Chosen only');
  const tiles = make('ul', {class: 'tiles', 'aria-label': `${title}: arrow keys move, space chooses`});
  const shown = () => boxes.filter(box => !box.closest('li').hidden);

  function choose(some, on) {
    const values = some.filter(box => chosen.has(box.value) !== on).map(box => box.value);
    if (!values.length) return;
    for (const value of values) on ? chosen.add(value) : chosen.delete(value);
    for (const box of boxes) box.checked = chosen.has(box.value);
    edited(values, on);
    refresh();
  }
  function refresh() {
    const all_shown = shown().length === boxes.length;
    all.textContent = all_shown ? 'Select all' : `Select the ${shown().length} shown`;
    none.textContent = all_shown ? 'Select none' : `Unselect the ${shown().length} shown`;
    all.disabled = none.disabled = shown().length === 0;
    count.textContent = `${chosen.size} of ${boxes.length} chosen` + (shown().length ? '' : '; no match');
    changed();
  }
  function reach(box) {  // one stop of the Tab key for the whole list
    for (const other of boxes) other.tabIndex = other === box ? 0 : -1;
  }
  for (const name of names) {
    const box = make('input', {type: 'checkbox', value: name});
    box.checked = chosen.has(name);
    box.addEventListener('change', () => choose([box], box.checked));
    box.addEventListener('focus', () => reach(box));
    boxes.push(box);
    tiles.append(make('li', {}, make('label', {class: 'tile'}, box, picture(feature, name), name)));
  }
  reach(boxes[0]);
  function filter() {  // what is unchosen later stays until the next change of the filter: nothing moves under the pointer
    const parts = search.value.toLowerCase().split(/\s+/), chosenOnly = only.getAttribute('aria-pressed') === 'true';
    for (const box of boxes)
      box.closest('li').hidden = !parts.every(part => box.value.toLowerCase().includes(part)) || (chosenOnly && !box.checked);
    if (shown().length) reach(shown()[0]);
    refresh();
  }
  search.addEventListener('input', filter);
  tiles.addEventListener('keydown', event => {
    const here = shown(), at = here.indexOf(event.target);
    const top = here.length ? here[0].closest('li').offsetTop : 0;
    const across = here.filter(box => box.closest('li').offsetTop === top).length;
    const to = {ArrowRight: at + 1, ArrowLeft: at - 1, ArrowDown: at + across, ArrowUp: at - across, Home: 0, End: here.length - 1}[event.key];
    if (to === undefined || at < 0) return;
    event.preventDefault();
    if (here[to]) here[to].focus();
  });
  refresh();
  return make('section', {'aria-label': title}, make('h2', {}, title), make('div', {class: 'tools'}, count, search, all, none, only), tiles);
}

const features = ['object_types', 'textures'];
const several = (n, one) => `${n} ${one}${n === 1 ? '' : 's'}`;
const opened = set => ({object_types: new Set(set.object_types), textures: new Set(set.textures)});
const named = set => ({object_types: [...set.object_types], textures: [...set.textures]});
const complete = set => set.object_types.size > 0 && set.textures.size > 0;
const counted = set => `${several(set.object_types.size, 'object type')}, ${several(set.textures.size, 'color')}`;

// The two lists of one set; `edited(feature, values, on)`.
const lists = (state, set, edited, changed) => make('div', {class: 'lists'}, ...features.map(
  feature => list(feature, state[feature], set[feature], (values, on) => edited(feature, values, on), changed)));

// A set that is one product: what it is, whether it can be submitted, and its part of the page.
function product(state, {role, phrase, first}, changed) {
  const chosen = opened(first);
  return {role, value: () => named(chosen), complete: () => complete(chosen), counted: () => counted(chosen),
          element: make('fieldset', {}, state.sets.length > 1 ? make('legend', {}, phrase[0].toUpperCase() + phrase.slice(1)) : '',
                        lists(state, chosen, (feature, values, on) => post('edit', {role, feature, values, on}), changed))};
}

const rules = {'': 'any of them', leftmost: 'the one farthest to the left', rightmost: 'the one farthest to the right',
               left_of: 'the one left of …', right_of: 'the one right of …', nearest_to: 'the one nearest to …',
               farthest_from: 'the one farthest from …', first_in: 'the one that comes first in this order …'};
const withReference = ['left_of', 'right_of', 'nearest_to', 'farthest_from'];

// A set that may be several kinds of objects, and say which of several on the table is meant.
function meaning(state, {role, first}, changed) {
  const kinds = first.sets.map(opened), which = first.which || {};
  const of = opened(which.of || {}), order = [...(which.order || [])];
  let rule = which.rule || '';
  const told = () => withReference.includes(rule) ? complete(of) : rule !== 'first_in' || order.length > 0;
  const value = () => ({sets: kinds.map(named), ...(rule && told() && {which: {
    rule, ...(withReference.includes(rule) && {of: named(of)}), ...(rule === 'first_in' && {order: [...order]})}})});
  const edited = () => {
    post('meant', {target: value()});
    changed();
  };
  const all = make('div'), reference = make('div');
  const drawKinds = () => all.replaceChildren(
    ...kinds.map((kind, i) => make('fieldset', {}, kinds.length > 1 ? make('legend', {}, `Kind ${i + 1}`) : '', lists(state, kind, edited, changed),
      kinds.length > 1 ? make('div', {class: 'buttons'}, button(`Remove kind ${i + 1}`, () => (kinds.splice(i, 1), drawKinds(), edited()), '')) : '')),
    make('div', {class: 'buttons'}, button('Add another kind of object', () => (kinds.push(opened({})), drawKinds(), edited()), '')));
  const drawOrder = () => {
    const feature = features.find(one => state[one].includes(order[0]));
    const next = make('select', {id: 'next'}, make('option', {value: ''}, 'Choose …'),
      ...features.filter(one => !order.length || one === feature).map(one => make('optgroup', {label: featureNames[one]},
        ...state[one].filter(name => !order.includes(name)).map(name => make('option', {}, name)))));
    next.addEventListener('change', () => (order.push(next.value), drawOrder(), edited(), document.getElementById('next').focus()));
    reference.replaceChildren(
      make('ol', {class: 'order'}, ...order.map((name, i) => make('li', {}, name, ' ',
        button(`Remove ${name}`, () => (order.splice(i, 1), drawOrder(), edited()), '')))),
      make('label', {for: 'next'}, order.length ? 'After these: ' : 'First: '), next);
  };
  const drawReference = () => rule === 'first_in' ? drawOrder()
    : reference.replaceChildren(...(withReference.includes(rule)
      ? [make('fieldset', {}, make('legend', {}, 'Of which object?'), lists(state, of, edited, changed))] : []));
  const choice = make('select', {id: 'which'}, ...Object.entries(rules).map(
    ([one, text]) => make('option', {value: one, selected: one === rule}, text)));
  choice.addEventListener('change', () => {
    rule = choice.value;
    drawReference();
    edited();
  });
  drawKinds();
  drawReference();
  return {role, value, complete: () => kinds.every(complete) && told(),
          counted: () => kinds.map(counted).join(', or ') + (rule ? `; ${rules[rule].replace('…', `(${counted(of)})`).replace(/ in this order .*/, '')}` : ''),
          element: make('section', {}, all, make('p', {class: 'which'},
            make('label', {for: 'which'}, 'If several of these are on the table, the robot should take '), choice), reference)};
}

// One question for each object: {element, complete(), answers()}.
function questions(pairs, changed) {
  const said = pairs.map(() => null);
  const one = ({object_type, texture}, i) => make('fieldset', {}, make('legend', {}, `${object_type}, ${texture}`),
    picture('pairs', `${object_type}, ${texture}`), make('div', {class: 'answers'}, ...['yes', 'no', 'can\'t tell'].map(answer =>
      make('label', {}, make('input', {type: 'radio', name: `pair${i}`, value: answer, onchange: () => (said[i] = answer, changed())}), answer))));
  return {element: make('div', {class: 'pairs'}, ...pairs.map(one)), left: () => said.filter(answer => !answer).length, answers: () => said};
}

function running(state) {
  const asked = state.pairs && questions(state.pairs, () => changed());
  const submit = button('Submit', () => {
    const selection = Object.fromEntries(sets.map(set => [set.role, set.value()]));
    submit.disabled = true;
    submit.textContent = 'Saving…';
    post('submit', {...(asked ? {answers: asked.answers()} : {selection}), longest_wait_ms: longestWait()});
    trial = null;
  });
  const bar = make('p', {class: 'soft', role: 'status'}), sets = [];
  const changed = () => {
    if (asked) {
      submit.disabled = asked.left() > 0;
      bar.textContent = asked.left() ? `${several(asked.left(), 'object')} left` : '';
      return;
    }
    if (sets.length < state.sets.length) return;  // the page is being made
    const whole = sets.every(set => set.complete());
    submit.disabled = !whole;
    bar.textContent = whole ? `Chosen: ${sets.map(set => set.counted()).join('; ')}`
      : 'Choose at least one object type and one color' + (sets.length > 1 || state.meanings ? ' in each part.' : '.');
  };
  for (const set of asked ? [] : state.sets) sets.push((state.meanings && set.role === 'target' ? meaning : product)(state, set, changed));
  changed();
  show(asked ? 'Could the command mean this object?' : 'Which objects could this command mean?', make('p', {class: 'command'}, `“${state.command}”`),
       ...(state.hint ? [make('p', {class: 'soft'}, `(${state.hint})`)] : []), ...(asked ? [asked.element] : sets.map(set => set.element)), make('div', {class: 'bar'}, submit, bar));
  longest = 0;
  requestAnimationFrame(() => requestAnimationFrame(() => {  // the command is painted
    trial = {lastInput: performance.now(), idle: false, away: false};
    post('shown');
    if (!document.hasFocus() || document.hidden) away(true);
  }));
}

function away(now) {
  if (!trial || trial.away === now) return;
  trial.away = now;
  post(now ? 'blur' : 'focus');
}

function input() {
  if (!trial) return;
  trial.lastInput = performance.now();
  if (!trial.idle) return;
  trial.idle = false;
  post('active');
}

setInterval(() => {
  if (!trial || trial.idle || performance.now() - trial.lastInput <= idleAfter) return;
  trial.idle = true;
  post('idle', {since_ms: trial.lastInput});
}, 1000);
for (const kind of ['keydown', 'pointerdown', 'pointermove', 'wheel', 'scroll', 'input'])
  window.addEventListener(kind, input, {capture: true, passive: true});
window.addEventListener('blur', () => away(true));
window.addEventListener('focus', () => away(false));
document.addEventListener('visibilitychange', () => away(document.hidden));

// --- questionnaire, debriefing ---

const scales = [
  ['mental', 'Mental demand: how mentally demanding was it?', 'very low', 'very high'],
  ['physical', 'Physical demand: how physically demanding was it?', 'very low', 'very high'],
  ['temporal', 'Temporal demand: how hurried or rushed was the pace?', 'very low', 'very high'],
  ['performance', 'Performance: how successful were you?', 'perfect', 'failure'],
  ['effort', 'Effort: how hard did you have to work?', 'very low', 'very high'],
  ['frustration', 'Frustration: how insecure, discouraged, irritated, stressed or annoyed were you?', 'very low', 'very high']];

function questionnaire(state) {
  const tlx = Object.fromEntries(scales.map(([name]) => [name, null]));
  const content = [];
  if (state.tlx)
    for (const [name, question, low, high] of scales) {
      const answer = make('output', {class: 'soft'}, 'not answered');
      const range = make('input', {type: 'range', min: 0, max: 100, step: 5, value: 50, id: name, class: 'open'});
      const take = () => {
        tlx[name] = Number(range.value);
        answer.textContent = range.value;
        range.classList.remove('open');
      };
      range.addEventListener('input', take);
      range.addEventListener('click', take);
      content.push(make('div', {class: 'scale'}, make('label', {for: name}, question), range,
                        make('div', {class: 'ends'}, make('span', {}, low), answer, make('span', {}, high))));
    }
  const text = make('textarea', {id: 'text', maxlength: 1000});
  if (state.free_text)
    content.push(make('p', {}, make('label', {for: 'text'}, 'Is there anything you want to say? Please do not name anyone.')), text);
  const send = button('Send', () => {
    send.disabled = true;
    post('questionnaire', {tlx, free_text: text.value});
  });
  const how = {human: 'the lists were empty at first', lga_hill: 'answers were filled in'}[state.condition];
  const which = how ? `the ${state.last ? 'second' : 'first'} part, in which ${how}` : 'all of them together';
  show(state.last ? 'Almost done' : 'The first part is done', words(...paragraphs(state.last
    ? `All commands are answered. These questions are about ${which}; leave out what you like.`
    : `These questions are about ${which}; leave out what you like. Then the second part begins.`),
                            ...content, make('div', {class: 'buttons'}, send)));
}

function debriefing(state) {
  show('Thank you', words(
    ...paragraphs('You have finished. Your answers are stored.',
                  state.of_pairs ? 'The study asks which objects people take a command to mean where its words leave that open.' : 'The study compares how long people need to say what a command means, from nothing and with a language model’s answer to correct, and how good the result is for a robot that learns from it.'),
    make('p', {}, 'Your withdrawal code: ', make('code', {}, state.withdrawal_code)),
    ...paragraphs('Please write it down. Whoever has it can have your answers deleted, at the address of this study with /withdraw at its end.',
                  `If you have a question: ${about.contact}`, 'You can close this page.')));
}

// --- where the session is ---

function enter(state) {
  trial = null;
  if (state.step === 'trial') return state.trial.running ? running(state.trial) : ready(state.trial);
  ({familiarisation, example, questionnaire, debriefing})[state.step](state);
}

async function begin() {
  about = (await deliver('/study.json')).json;
  document.title = about.title;
  document.getElementById('rehearsal').hidden = !about.rehearsal;
  if (location.pathname === '/withdraw') return withdraw();
  if (!id) return location.pathname === '/' ? consent() : gone();
  for (const feature of Object.keys(about.pictures).filter(one => about.pictures[one])) {  // no picture comes in while time runs
    const image = new Image();
    image.src = `/${feature}.png`;
    await image.decode().catch(() => {});
  }
  post('opened');
}

begin();

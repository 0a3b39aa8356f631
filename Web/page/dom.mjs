/** @param {string} selector @returns {any} an element that the page has */
export function find(selector) {
  const found = document.querySelector(selector);
  if (!found) throw new Error(`the page has no ${selector}`);
  return found;
}

/**
 * @param {string} tag
 * @param {Record<string, any>} [properties] of the element; names with a hyphen are attributes
 * @param {(Node | string)[]} [children]
 * @returns {any}
 */
export function make(tag, properties = {}, children = []) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.includes('-')) element.setAttribute(name, value);
    else /** @type {any} */ (element)[name] = value;
  }
  element.append(...children);
  return element;
}

/** Fills a selection and keeps what was chosen. @param {HTMLSelectElement} select @param {{value: string, text: string}[]} options */
export function fillSelect(select, options) {
  const chosen = select.value;
  select.replaceChildren(...options.map(({ value, text }) => make('option', { value, textContent: text })));
  if (options.some(({ value }) => value === chosen)) select.value = chosen;
}

/** Hands a file to the user. @param {string} name @param {BlobPart} content @param {string} type */
export function download(name, content, type) {
  const address = URL.createObjectURL(new Blob([content], { type }));
  const link = make('a', { href: address, download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}

/** A number for a reader: a dash where there is none. @param {number | undefined} value @param {number} digits */
export const shown = (value, digits) => (value !== undefined && Number.isFinite(value) ? value.toFixed(digits) : '–');

/** Ties a range to its output and its setting. @param {string} id @param {(value: number) => string} text @param {(value: number) => void} apply */
export function slider(id, text, apply) {
  const input = find(`#${id}`);
  const output = find(`output[for="${id}"]`);
  const update = () => {
    output.textContent = text(Number(input.value));
    input.setAttribute('aria-valuetext', output.textContent);
    apply(Number(input.value));
  };
  input.addEventListener('input', update);
  update();
  return {
    get value() {
      return Number(input.value);
    },
    set value(value) {
      input.value = String(value);
      update();
    },
  };
}

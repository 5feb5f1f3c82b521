// The page's elements by their ids, and updates of them.

/**
 * @param {string} id
 * @returns {any} The caller knows the kind of element.
 */
export const $ = (id) => document.getElementById(id);

/**
 * Sets the properties of an element that differ from their current values: writing a property causes a new layout, even
 * with the same value.
 * @param {any} element
 * @param {object} properties
 */
export function setProperties(element, properties) {
  for (const [name, value] of Object.entries(properties)) if (element[name] !== value) element[name] = value;
}

/**
 * The same for attributes; null removes one.
 * @param {Element} element
 * @param {object} attributes
 */
export function setAttributes(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null) element.removeAttribute(name);
    else if (element.getAttribute(name) !== value) element.setAttribute(name, value);
  }
}

/**
 * Lets a button wait for what it has begun. A disabled button would lose the focus: this one keeps it, and whoever
 * listens to it asks `isWaiting`.
 * @param {Element} button
 * @param {boolean} waiting
 */
export const setWaiting = (button, waiting) => setAttributes(button, { "aria-disabled": waiting ? "true" : null });

/** @param {Element} button */
export const isWaiting = (button) => button.getAttribute("aria-disabled") === "true";

/**
 * Replaces the content of a list of buttons. If one of them has the focus, that goes to the button of the same kind in
 * the same place, or to another one if there is none.
 * @param {HTMLElement} list
 * @param {string} html
 * @param {HTMLElement} other
 */
export function replaceButtons(list, html, other) {
  if (list.innerHTML === html) return;
  const kind = list.contains(document.activeElement) ? document.activeElement.className : "";
  const alike = () => /** @type {any[]} */ ([...list.getElementsByClassName(kind)]);
  const at = alike().indexOf(document.activeElement);
  list.innerHTML = html;
  if (kind) (alike()[at] ?? other).focus();
}

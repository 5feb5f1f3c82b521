import js from "@eslint/js";

// Which names there are is known to TypeScript, which checks the same files.
export default [js.configs.recommended, { rules: { "no-undef": "off", eqeqeq: "error", "prefer-const": "error" } }];

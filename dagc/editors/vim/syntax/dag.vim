" Decision graphs and catalogs of dagc.
" SPDX-License-Identifier: MIT
if exists("b:current_syntax")
  finish
endif

syntax keyword dagStructure import graph oracle catalog runtime verb unit type term fact role extern tool decision
syntax keyword dagStatement node start fixed param exits
syntax keyword dagModifier answers reads writes guards by after counts records header wave anywhere levels subdivides question command abi in standard
syntax keyword dagKind precise approximate other refuses
syntax keyword dagType real integer
syntax keyword dagDefault otherwise
syntax keyword dagNumber inf
syntax match   dagNumber "\<\d\+\(\.\d*\)\?\([eE][-+]\?\d\+\)\?\>"
syntax match   dagFunction "\<\(min\|max\|sqrt\|abs\)\>\ze\s*("
syntax match   dagArrow "->\|>="
syntax region  dagString start=+"+ skip=+\\.+ end=+"+ oneline contains=dagEscape
syntax match   dagEscape +\\["\\]+ contained
syntax match   dagComment "#.*$" contains=dagTodo,@Spell
syntax keyword dagTodo TODO FIXME contained

highlight default link dagStructure Structure
highlight default link dagStatement Statement
highlight default link dagModifier  StorageClass
highlight default link dagKind      Constant
highlight default link dagType      Type
highlight default link dagDefault   Conditional
highlight default link dagNumber    Number
highlight default link dagFunction  Function
highlight default link dagArrow     Operator
highlight default link dagString    String
highlight default link dagEscape    SpecialChar
highlight default link dagComment   Comment
highlight default link dagTodo      Todo

let b:current_syntax = "dag"

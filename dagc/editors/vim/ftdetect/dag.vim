" SPDX-License-Identifier: MIT
autocmd BufRead,BufNewFile *.dag setfiletype dag

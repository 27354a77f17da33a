-- Pages link to each other as Markdown in the sources, and as HTML where they are read.
function Link(link)
  link.target = link.target:gsub("^([%w-]+)%.md", "%1.html")
  return link
end

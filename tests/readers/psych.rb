# Psych, the reader of YAML that Ruby ships: `psych.rb FILE`. See walk.py for what is told.

require "json"
require "yaml"

def hex(text)
  text.encode(Encoding::UTF_8).unpack1("H*")
end

def walk(value, lines)
  say = ->(*words) { lines << JSON.generate(words) }
  case value
  when nil then say.("null")
  when true, false then say.("bool", value)
  when Integer then say.("integer", value.to_s)
  when Float then say.("number", [value].pack("G").unpack1("H*"))
  when String then say.("text", hex(value))
  when Array
    say.("list")
    value.each { |item| walk(item, lines) }
    say.("end")
  when Hash
    say.("map")
    value.each do |key, item|
      key.is_a?(String) ? say.("key", hex(key)) : say.("other", "a key of type #{key.class}")
      walk(item, lines)
    end
    say.("end")
  else say.("other", value.class.name)
  end
end

lines = []
walk(YAML.safe_load(File.read(ARGV.fetch(0), mode: "rb", encoding: "UTF-8")), lines)
puts lines
